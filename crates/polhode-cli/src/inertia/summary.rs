//! One line a link, the troubles below, and totals.

use std::fmt::Write;

use polhode_files::examined::{Examined, Worth};
use polhode_files::text::{short, visible};

use super::model::Model;

/// Columns of a terminal.
const WIDTH: usize = 80;
/// Of the numbers and the verdict.
const NUMBERS: usize = 4 * 11 + 12;

/// The links of every model, their troubles and totals.
pub(super) fn table(models: &[Model]) -> String {
    let several = models.len() > 1;
    let mut text = String::new();
    for (k, model) in models.iter().enumerate() {
        if several {
            let blank = if k > 0 { "\n" } else { "" };
            let _ = writeln!(text, "{blank}{}", visible(&model.path));
        }
        text += &links(&model.links);
        let told = troubles(std::slice::from_ref(model));
        if !told.is_empty() {
            let _ = writeln!(text, "\n{told}");
        }
        let _ = writeln!(text, "\n{}", totals(&model.links));
    }
    if several {
        let all: Vec<&Examined> = models.iter().flat_map(|model| &model.links).collect();
        let _ = writeln!(text, "\n{} models, {}", models.len(), counts(&all));
    }
    text
}

fn links(links: &[Examined]) -> String {
    let names: Vec<String> = links.iter().map(Examined::name).collect();
    let widest = names.iter().map(|name| name.chars().count()).max().unwrap_or(0);
    let width = widest.clamp(4, WIDTH - NUMBERS);
    let mut text = String::new();
    let _ = writeln!(
        text,
        "{:width$} {:>10} {:>10} {:>10} {:>10}  verdict",
        "link", "mass [kg]", "I1 [kg m2]", "I2", "I3"
    );
    for (link, name) in links.iter().zip(names) {
        let moments = match (&link.body, &link.diagnosis) {
            (Some(body), _) => body.principal_moments().map(digits),
            (None, Some(found)) => found.principal_moments.map(digits),
            (None, None) => [const { String::new() }; 3],
        };
        let mass = if link.worth() == Worth::Massless {
            String::new()
        } else {
            link.given.mass.map_or(String::new(), digits)
        };
        let [a, b, c] = moments;
        let _ = writeln!(
            text,
            "{:width$} {mass:>10} {a:>10} {b:>10} {c:>10}  {}",
            cut(&name, width),
            link.worth().name()
        );
    }
    text
}

/// A name that is longer than its column keeps its two ends, which tell links apart.
fn cut(name: &str, width: usize) -> String {
    let letters: Vec<char> = name.chars().collect();
    if letters.len() <= width {
        return name.into();
    }
    let head = (width - 2) / 2;
    let tail = width - 2 - head;
    letters[..head].iter().chain(&['.', '.']).chain(&letters[letters.len() - tail..]).collect()
}

/// Four digits.
fn digits(x: f64) -> String {
    let near: f64 = format!("{x:.3e}").parse().unwrap_or(x);
    short(near + 0.0)
}

/// What stands in the way of links that are not valid, and the likely cause; what several have in common is told once.
pub(super) fn troubles(models: &[Model]) -> String {
    let several = models.len() > 1;
    let mut told: Vec<(String, Vec<String>)> = Vec::new();
    for model in models {
        for link in &model.links {
            let name =
                if several { format!("{} {}", visible(&model.path), link.name()) } else { link.name() };
            let message = match (link.worth(), &link.given.remark) {
                (Worth::Invalid | Worth::Suspicious, _) => trouble(link),
                (_, Some(remark)) => format!("note: {}", visible(remark)),
                _ => continue,
            };
            match told.iter_mut().find(|(known, _)| *known == message) {
                Some((_, names)) => names.push(name),
                None => told.push((message, vec![name])),
            }
        }
    }
    let each = told.into_iter().map(|(message, names)| format!("{}: {message}", names.join(", ")));
    each.collect::<Vec<_>>().join("\n")
}

fn trouble(link: &Examined) -> String {
    let mut text = link.trouble().unwrap_or_default();
    if let Some(cause) = link.cause().filter(|cause| !text.contains(cause.as_str())) {
        let _ = write!(text, "\n  cause: {cause}");
    }
    text
}

/// Everything that is to be said about the links that are not valid.
pub(super) fn reports(models: &[Model]) -> String {
    let links = models.iter().flat_map(|model| &model.links);
    let poor = links.filter(|link| matches!(link.worth(), Worth::Invalid | Worth::Suspicious));
    poor.map(Examined::report).collect::<Vec<_>>().join("\n")
}

fn totals(links: &[Examined]) -> String {
    let all: Vec<&Examined> = links.iter().collect();
    let mass: f64 = links.iter().filter_map(|link| link.given.mass).sum();
    format!("{}; {} kg in all", counts(&all), digits(mass))
}

fn counts(links: &[&Examined]) -> String {
    let of = |worth: Worth| links.iter().filter(|link| link.worth() == worth).count();
    let each = Worth::ALL.into_iter().filter(|worth| of(*worth) > 0);
    let each: Vec<String> = each.map(|worth| format!("{} {}", of(worth), worth.name())).collect();
    let links = match links.len() {
        1 => "1 link".to_owned(),
        many => format!("{many} links"),
    };
    format!("{links}: {}", each.join(", "))
}

/// How many links are invalid, in a sentence.
pub(super) fn count_of_invalid(models: &[Model]) -> String {
    let links: Vec<&Examined> = models.iter().flat_map(|model| &model.links).collect();
    let invalid = links.iter().filter(|link| link.worth() == Worth::Invalid).count();
    let are = if invalid == 1 { "is" } else { "are" };
    format!("{invalid} of {} links {are} invalid", links.len())
}
