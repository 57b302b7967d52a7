//! Bodies as rows, JSON and fragments of models.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use polhode::inertia::MassProperties;
use serde_json::{Value, json};

use super::Form;
use super::examined::{Examined, six};
use crate::table::{Cell, Column, Format, Table, row};
use crate::text::{visible, visible_json};

/// The sign of the products, which no two programs agree on.
const SIGN: &str = "I_xy = -int x y dm";

/// All bodies in one text.
pub(super) fn write(bodies: &[Examined], form: Form) -> String {
    let each = |write: fn(&Examined, &MassProperties) -> String| -> String {
        bodies
            .iter()
            .filter_map(|body| body.body.as_ref().map(|properties| write(body, properties)))
            .collect()
    };
    match form {
        Form::Table => bodies.iter().map(sheet).collect::<Vec<_>>().join("\n"),
        Form::Csv => Format::Csv.write(&rows(bodies)),
        Form::Json => match bodies {
            [one] => json(one) + "\n",
            many => format!("[\n{}\n]\n", many.iter().map(json).collect::<Vec<_>>().join(",\n")),
        },
        Form::Urdf => each(urdf),
        Form::Mjcf => each(mjcf),
        Form::MjcfDiagonal => each(mjcf_diagonal),
        Form::Toml => each(toml),
    }
}

/// The quantities of a body: name, unit, value.
fn quantities(examined: &Examined) -> Vec<(&'static str, &'static str, Cell)> {
    let found = &examined.diagnosis;
    let body = examined.body.as_ref();
    let center = examined.given.center_of_mass;
    let moments = body.map_or(found.principal_moments, MassProperties::principal_moments);
    let axes = body.map(|body| quaternion(body.principal_axes()));
    let margins = body.map_or(found.triangle_margins, MassProperties::triangle_margins);
    let tensor = six(&body.map_or(examined.given.tensor, MassProperties::tensor));
    let mut list = vec![
        ("name", "", Cell::from(examined.given.name.as_str())),
        ("mass", "kg", examined.given.mass.into()),
    ];
    let mut add = |names: &[&'static str], unit, values: &[f64]| {
        list.extend(names.iter().zip(values).map(|(&name, &value)| (name, unit, Cell::from(value + 0.0))));
    };
    add(&["center_of_mass_x", "center_of_mass_y", "center_of_mass_z"], "m", center.as_slice());
    add(
        &["inertia_xx", "inertia_yy", "inertia_zz", "inertia_xy", "inertia_xz", "inertia_yz"],
        "kg m^2",
        &tensor,
    );
    add(&["moment_1", "moment_2", "moment_3"], "kg m^2", &moments);
    match axes {
        Some(axes) => add(&["axes_w", "axes_x", "axes_y", "axes_z"], "", &axes),
        None => add(&["axes_w", "axes_x", "axes_y", "axes_z"], "", &[f64::NAN; 4]),
    }
    add(&["margin_1", "margin_2", "margin_3"], "kg m^2", &margins);
    list.push(("class", "", class(examined).into()));
    list.push(("verdict", "", examined.verdict_name().into()));
    list.push(("trouble", "", examined.trouble().into()));
    list.push(("cause", "", found.causes.first().map(|explanation| explanation.cause.to_string()).into()));
    let mut add = |names: &[&'static str], unit, values: &[f64]| {
        list.extend(names.iter().zip(values).map(|(&name, &value)| (name, unit, Cell::from(value + 0.0))));
    };
    add(&["distance"], "kg m^2", &[found.distance]);
    let edge = if examined.given.mass.is_some() { "m" } else { "" };
    add(&["box_1", "box_2", "box_3"], edge, &found.equivalent_box);
    if let Some((point, tensor)) = &examined.about {
        add(&["point_x", "point_y", "point_z"], "m", point.as_slice());
        let names = ["about_xx", "about_yy", "about_zz", "about_xy", "about_xz", "about_yz"];
        add(&names, "kg m^2", &tensor.as_ref().map_or([f64::NAN; 6], six)); // an empty cell
    }
    list
}

fn class(examined: &Examined) -> &'static str {
    examined.body.as_ref().map_or("none", |body| body.class().name())
}

/// A row a body.
fn rows(bodies: &[Examined]) -> Table {
    let all: Vec<_> = bodies.iter().map(quantities).collect();
    let columns = all.first().map_or(&[][..], Vec::as_slice).iter();
    let columns = columns.map(|(name, unit, _)| Column::new(name, unit, "")).collect();
    let mut table = Table::new("inertia", "Mass properties.", columns);
    for quantities in all {
        table.push(quantities.into_iter().map(|(_, _, value)| value));
    }
    table
}

/// One line per quantity.
fn sheet(examined: &Examined) -> String {
    let columns = vec![
        Column::new("quantity", "", ""),
        Column::new("value", "", "").digits(9),
        Column::new("unit", "", ""),
    ];
    let mut table = Table::new("inertia", "Mass properties.", columns);
    for (name, unit, value) in quantities(examined) {
        if value != Cell::Empty && value != Cell::from("") {
            table.push(row![name, value, unit]);
        }
    }
    format!(
        "{}\n{SIGN}, about the centre of mass;\naxes: quaternion, principal axes to frame\n",
        table.terminal()
    )
}

/// The object of the conventions, then what the examination adds.
fn json(examined: &Examined) -> String {
    let found = &examined.diagnosis;
    let body = examined.body.as_ref();
    let vector = |values: &[f64]| Value::from(values.iter().map(|x| x + 0.0).collect::<Vec<f64>>());
    let matrix =
        |m: &Matrix3<f64>| Value::from([0, 1, 2].map(|j| vector(&[0, 1, 2].map(|k| m[(j, k)]))).to_vec());
    let causes: Vec<Value> = found
        .causes
        .iter()
        .map(|explanation| {
            json!({
                "cause": explanation.cause.name(),
                "meaning": explanation.cause.to_string(),
                "inertia": matrix(&explanation.corrected),
            })
        })
        .collect();
    let mut entries = vec![
        ("mass", examined.given.mass.into()),
        ("center_of_mass", vector(examined.given.center_of_mass.as_slice())),
        ("inertia", matrix(&body.map_or(examined.given.tensor, MassProperties::tensor))),
        (
            "principal_moments",
            vector(&body.map_or(found.principal_moments, MassProperties::principal_moments)),
        ),
        ("axes", body.map_or(Value::Null, |body| vector(&quaternion(body.principal_axes())))),
        ("class", class(examined).into()),
        ("triangle_margins", vector(&body.map_or(found.triangle_margins, MassProperties::triangle_margins))),
        ("sign", SIGN.into()),
        ("verdict", examined.verdict_name().into()),
        ("trouble", examined.trouble().into()),
        ("causes", causes.into()),
        // in the axes it was typed in, like the causes; of a valid tensor it is the tensor itself
        ("nearest", matrix(&body.map_or(found.nearest, MassProperties::tensor))),
        ("distance", found.distance.into()),
        ("equivalent_box", vector(&found.equivalent_box)),
    ];
    if !examined.given.name.is_empty() {
        entries.insert(0, ("name", examined.given.name.as_str().into()));
    }
    if let Some((point, tensor)) = &examined.about {
        entries.push((
            "about",
            json!({"point": vector(point.as_slice()), "inertia": tensor.as_ref().map(matrix)}),
        ));
    }
    let line = |(name, value): &(&str, Value)| format!("  \"{name}\": {}", visible_json(&value.to_string()));
    format!("{{\n{}\n}}", entries.iter().map(line).collect::<Vec<_>>().join(",\n"))
}

fn quaternion(q: UnitQuaternion<f64>) -> [f64; 4] {
    [q.w, q.i, q.j, q.k]
}

/// Numbers with every digit, separated by `separator`.
fn digits(values: &[f64], separator: &str) -> String {
    values.iter().map(|x| format!("{:?}", x + 0.0)).collect::<Vec<_>>().join(separator)
}

/// `<!-- … -->`; two hyphens would end it early.
fn comment(examined: &Examined, axes: &str) -> String {
    let name = visible(&examined.given.name).replace("--", "- -");
    let of = if name.is_empty() { name } else { format!("{name}: ") };
    format!("<!-- {of}kg, m; tensor entries, {SIGN}, about the centre of mass, {axes} -->\n")
}

fn urdf(examined: &Examined, body: &MassProperties) -> String {
    let [xx, yy, zz, xy, xz, yz] = six(&body.tensor()).map(|x| format!("{x:?}"));
    format!(
        "{}<inertial>\n  <origin xyz=\"{}\" rpy=\"0 0 0\"/>\n  <mass value=\"{}\"/>\n  \
         <inertia ixx=\"{xx}\" ixy=\"{xy}\" ixz=\"{xz}\" iyy=\"{yy}\" iyz=\"{yz}\" izz=\"{zz}\"/>\n</inertial>\n",
        comment(examined, "axes of the link"),
        digits(body.center_of_mass().as_slice(), " "),
        digits(&[body.mass()], ""),
    )
}

fn mjcf(examined: &Examined, body: &MassProperties) -> String {
    format!(
        "{}<inertial pos=\"{}\" mass=\"{}\" fullinertia=\"{}\"/>\n",
        comment(examined, "order xx yy zz xy xz yz"),
        digits(body.center_of_mass().as_slice(), " "),
        digits(&[body.mass()], ""),
        digits(&six(&body.tensor()), " "),
    )
}

fn mjcf_diagonal(examined: &Examined, body: &MassProperties) -> String {
    format!(
        "{}<inertial pos=\"{}\" quat=\"{}\" mass=\"{}\" diaginertia=\"{}\"/>\n",
        comment(examined, "quat w x y z turns principal axes to those of the body"),
        digits(body.center_of_mass().as_slice(), " "),
        digits(&quaternion(body.principal_axes()), " "),
        digits(&[body.mass()], ""),
        digits(&body.principal_moments(), " "),
    )
}

fn toml(examined: &Examined, body: &MassProperties) -> String {
    let name = &examined.given.name;
    let name = if name.is_empty() {
        String::new()
    } else {
        format!("name = {}\n", visible_json(&Value::from(name.as_str()).to_string()))
    };
    let center: Vector3<f64> = body.center_of_mass();
    format!(
        "# kg, m; inertia: Ixx, Iyy, Izz, Ixy, Ixz, Iyz, {SIGN}, about the centre of mass, which is at `at`\n\
         [[part]]\n{name}shape = \"tensor\"\nmass = {}\ninertia = [{}]\nat = [{}]\n",
        digits(&[body.mass()], ""),
        digits(&six(&body.tensor()), ", "),
        digits(center.as_slice(), ", "),
    )
}
