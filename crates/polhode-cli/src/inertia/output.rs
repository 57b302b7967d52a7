//! Bodies as rows, JSON and fragments of models.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use polhode::inertia::{Diagnosis, MassProperties};
use polhode_files::error::warn;
use polhode_files::examined::{Examined, six};
use polhode_files::text::{visible, visible_json};
use polhode_pages::table::{Cell, Column, Format, Table, row};
use serde_json::{Value, json};

use super::Form;

/// The sign of the products, which no two programs agree on.
const SIGN: &str = "I_xy = -int x y dm";

/// All bodies in one text; `files` are the files that they are from, where there are several.
pub(super) fn write(bodies: &[Examined], files: &[String], form: Form) -> String {
    let each = |write: fn(&Examined, &MassProperties) -> String| -> String {
        bodies
            .iter()
            .filter_map(|body| body.body.as_ref().map(|properties| write(body, properties)))
            .collect()
    };
    match form {
        Form::Table => bodies.iter().map(sheet).collect::<Vec<_>>().join("\n"),
        Form::Csv => {
            if let Some(remark) = remark_on_formulas(bodies) {
                warn(&remark);
            }
            Format::Csv.write(&rows(bodies, files))
        }
        Form::Json => match bodies {
            [one] => json(one, files.first()) + "\n",
            many => {
                let each = many.iter().enumerate().map(|(k, body)| json(body, files.get(k)));
                format!("[\n{}\n]\n", each.collect::<Vec<_>>().join(",\n"))
            }
        },
        Form::Urdf => each(urdf),
        Form::Mjcf => each(mjcf),
        Form::MjcfDiagonal => each(mjcf_diagonal),
        Form::Toml => each(toml),
    }
}

/// The quantities of a body: name, unit, value.
fn quantities(examined: &Examined) -> Vec<(&'static str, &'static str, Cell)> {
    const NONE: [f64; 3] = [f64::NAN; 3]; // empty cells
    let found = examined.diagnosis.as_ref();
    let body = examined.body.as_ref();
    let center = found.map_or(NONE, |_| examined.given.center_of_mass.into());
    let moments =
        body.map_or(found.map_or(NONE, |found| found.principal_moments), MassProperties::principal_moments);
    let axes = body.map_or([f64::NAN; 4], |body| quaternion(body.principal_axes()));
    let margins =
        body.map_or(found.map_or(NONE, |found| found.triangle_margins), MassProperties::triangle_margins);
    let tensor = found.map(|_| six(&body.map_or(examined.given.tensor, MassProperties::tensor)));
    let mut list = vec![
        ("name", "", Cell::from(examined.given.name.as_str())),
        ("mass", "kg", examined.given.mass.into()),
    ];
    let mut add = |names: &[&'static str], unit, values: &[f64]| {
        list.extend(names.iter().zip(values).map(|(&name, &value)| (name, unit, Cell::from(value + 0.0))));
    };
    add(&["center_of_mass_x", "center_of_mass_y", "center_of_mass_z"], "m", &center);
    add(
        &["inertia_xx", "inertia_yy", "inertia_zz", "inertia_xy", "inertia_xz", "inertia_yz"],
        "kg m^2",
        &tensor.unwrap_or([f64::NAN; 6]),
    );
    add(&["moment_1", "moment_2", "moment_3"], "kg m^2", &moments);
    add(&["axes_w", "axes_x", "axes_y", "axes_z"], "", &axes);
    add(&["margin_1", "margin_2", "margin_3"], "kg m^2", &margins);
    list.push(("class", "", class(examined).into()));
    list.push(("verdict", "", examined.worth().name().into()));
    list.push(("trouble", "", examined.trouble().into()));
    list.push(("cause", "", examined.cause().into()));
    let mut add = |names: &[&'static str], unit, values: &[f64]| {
        list.extend(names.iter().zip(values).map(|(&name, &value)| (name, unit, Cell::from(value + 0.0))));
    };
    add(&["distance"], "kg m^2", &[found.map_or(f64::NAN, |found| found.distance)]);
    let edge = if examined.given.mass.is_some() { "m" } else { "" };
    add(&["box_1", "box_2", "box_3"], edge, &found.map_or(NONE, |found| found.equivalent_box));
    if let Some((point, tensor)) = &examined.about {
        add(&["point_x", "point_y", "point_z"], "m", point.as_slice());
        let names = ["about_xx", "about_yy", "about_zz", "about_xy", "about_xz", "about_yz"];
        add(&names, "kg m^2", &tensor.as_ref().map_or([f64::NAN; 6], six)); // an empty cell
    }
    if examined.given.place.is_some() {
        list.push(("remark", "", examined.given.remark.clone().into()));
    }
    list
}

fn class(examined: &Examined) -> &'static str {
    examined.body.as_ref().map_or("none", |body| body.class().name())
}

/// A row a body.
fn rows(bodies: &[Examined], files: &[String]) -> Table {
    let all: Vec<_> = bodies.iter().map(quantities).collect();
    let columns = all.first().map_or(&[][..], Vec::as_slice).iter();
    let columns = columns.map(|(name, unit, _)| Column::new(name, unit, ""));
    let file = (!files.is_empty()).then(|| Column::new("file", "", ""));
    let mut table = Table::new("inertia", "Mass properties.", file.into_iter().chain(columns).collect());
    for (k, quantities) in all.into_iter().enumerate() {
        let file = files.get(k).map(|file| Cell::from(file.as_str()));
        let cells = file.into_iter().chain(quantities.into_iter().map(|(_, _, value)| value));
        table.push(cells.map(|cell| match cell {
            Cell::Text(text) if is_formula(&text) => Cell::from(format!("'{text}")),
            cell => cell,
        }));
    }
    table
}

/// Whether a spreadsheet would run a cell instead of showing it.
fn is_formula(text: &str) -> bool {
    text.starts_with(['=', '+', '-', '@', '\t', '\r'])
}

/// What is said of names that a CSV holds with an apostrophe before them.
fn remark_on_formulas(bodies: &[Examined]) -> Option<String> {
    let name = bodies.iter().map(|body| &body.given.name).find(|name| is_formula(name))?;
    Some(format!(
        "name '{}': a spreadsheet would run it as a formula; texts that begin with =, +, -, @ or a tab get an apostrophe before them in the CSV, and are unchanged with --format json",
        visible(name)
    ))
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
fn json(examined: &Examined, file: Option<&String>) -> String {
    let found = examined.diagnosis.as_ref();
    let body = examined.body.as_ref();
    let vector = |values: &[f64]| Value::from(values.iter().map(|x| x + 0.0).collect::<Vec<f64>>());
    let matrix =
        |m: &Matrix3<f64>| Value::from([0, 1, 2].map(|j| vector(&[0, 1, 2].map(|k| m[(j, k)]))).to_vec());
    let causes = found.map_or(&[][..], |found| found.causes.as_slice()).iter().map(|explanation| {
        json!({
            "cause": explanation.cause.name(),
            "meaning": explanation.cause.to_string(),
            "inertia": matrix(&explanation.corrected),
        })
    });
    let of = |value: &dyn Fn(&Diagnosis) -> Value| found.map_or(Value::Null, value);
    let tensor = body.map_or(examined.given.tensor, MassProperties::tensor);
    let mut entries = vec![
        ("mass", examined.given.mass.into()),
        ("center_of_mass", of(&|_| vector(examined.given.center_of_mass.as_slice()))),
        ("inertia", of(&|_| matrix(&tensor))),
        (
            "principal_moments",
            of(&|found| vector(&body.map_or(found.principal_moments, MassProperties::principal_moments))),
        ),
        ("axes", body.map_or(Value::Null, |body| vector(&quaternion(body.principal_axes())))),
        ("class", class(examined).into()),
        (
            "triangle_margins",
            of(&|found| vector(&body.map_or(found.triangle_margins, MassProperties::triangle_margins))),
        ),
        ("sign", SIGN.into()),
        ("verdict", examined.worth().name().into()),
        ("trouble", examined.trouble().into()),
        ("cause", examined.cause().into()),
        ("causes", causes.collect::<Vec<Value>>().into()),
        // in the axes it was typed in, like the causes; of a valid tensor it is the tensor itself
        ("nearest", of(&|found| matrix(&body.map_or(found.nearest, MassProperties::tensor)))),
        ("distance", of(&|found| found.distance.into())),
        ("equivalent_box", of(&|found| vector(&found.equivalent_box))),
    ];
    if !examined.given.name.is_empty() || examined.given.place.is_some() {
        entries.insert(0, ("name", examined.given.name.as_str().into()));
    }
    if let Some(file) = file {
        entries.insert(0, ("file", file.as_str().into()));
    }
    if let Some(remark) = &examined.given.remark {
        entries.push(("remark", remark.as_str().into()));
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

/// Scalar first; what rounding leaves of a zero is zero.
fn quaternion(q: UnitQuaternion<f64>) -> [f64; 4] {
    [q.w, q.i, q.j, q.k].map(|x| if x.abs() < f64::EPSILON { 0.0 } else { x })
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
