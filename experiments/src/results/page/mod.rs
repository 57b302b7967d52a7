//! `polhode experiment run --report`: all that was found on one page, which needs no network.

mod turning;

use std::fmt::Write as _;
use std::path::Path;

use polhode_files::error::Error;
use polhode_files::text::escaped_html as escaped;
use polhode_pages::document::{Tone, VERDICT_STYLE};
use polhode_pages::output::Output;
use polhode_pages::table::Table;

use super::provenance;
use crate::experiment::{Experiment, Report, Scale};
use crate::experiments::Which;
use turning::{Turning, turning};

const STYLE: &str = include_str!("style.css");
const SCRIPT: &str = include_str!("script.js");

/// The experiment whose costs are the verdict.
const VERDICT: &str = "work-precision";

/// A page under way.
pub(super) struct Page {
    /// Opened before the work, so that a place that cannot be written is found out first.
    output: Output,
    scale: Scale,
    verdict: Option<String>,
    contents: Vec<&'static str>,
    sections: String,
    conclusions: Vec<String>,
    checks: u64,
    failures: Vec<String>,
    runs: String,
}

impl Page {
    /// # Errors
    /// A place that cannot be written.
    pub(super) fn new(path: &Path, scale: Scale) -> Result<Self, Error> {
        Ok(Self {
            output: Output::to_file("--report", path)?,
            scale,
            verdict: None,
            contents: Vec::new(),
            sections: String::new(),
            conclusions: Vec::new(),
            checks: 0,
            failures: Vec::new(),
            runs: String::new(),
        })
    }

    /// Takes the results of one experiment.
    pub(super) fn add(&mut self, experiment: &Experiment, report: &Report) -> Result<(), Error> {
        let name = experiment.name;
        let question = escaped(experiment.question);
        let _ =
            writeln!(self.sections, "<section id=\"{name}\">\n<h2>{name}</h2>\n<p>It asks {question}.</p>");
        self.checks += report.checks;
        if !report.conclusion.is_empty() {
            let _ = writeln!(
                self.sections,
                "<p>It finds: {}.</p>",
                escaped(report.conclusion.trim_end_matches(['.', '\n']))
            );
            self.conclusions.push(format!("<a href=\"#{name}\">{name}</a>: {}", escaped(&report.conclusion)));
        }
        for failure in &report.failures {
            let failure = escaped(failure);
            let _ = writeln!(self.sections, "<p class=\"failed\">Failed: {failure}</p>");
            self.failures.push(format!("<a href=\"#{name}\">{name}</a>: {failure}"));
        }
        for figure in &report.figures {
            self.figure(&figure.title, &figure.svg());
        }
        for drawing in &report.drawings {
            self.figure("", &drawing.svg);
        }
        let shown = if report.views.is_empty() { &report.tables } else { &report.views };
        for table in shown.iter().chain(&report.timing) {
            self.sections += &titled(table);
        }
        self.sections += "</section>\n";
        if name == VERDICT {
            self.verdict =
                report.times.iter().find(|table| table.name == "costs").map(verdict).transpose()?;
        }
        let _ = writeln!(
            self.runs,
            "<details><summary>{name}</summary><pre>{}</pre></details>",
            escaped(&provenance::describe(name, self.scale, report))
        );
        self.contents.push(name);
        Ok(())
    }

    fn figure(&mut self, caption: &str, svg: &str) {
        // the head of a file is none of a page's
        let svg = svg.find("<svg").map_or("", |at| &svg[at..]);
        let caption = escaped(caption);
        let _ = writeln!(self.sections, "<figure role=\"img\" aria-label=\"{caption}\">\n{svg}\n</figure>");
    }

    /// Writes the page in its place.
    pub(super) fn finish(self) -> Result<(), Error> {
        let links: String = ["verdict", "turn"]
            .iter()
            .chain(&self.contents)
            .chain(&["provenance"])
            .map(|name| format!("<a href=\"#{name}\">{name}</a>\n"))
            .collect();
        let verdict = self.verdict.unwrap_or_else(|| {
            format!("<p>Which method is the quickest is asked by the experiment {VERDICT}, which was not run.</p>\n")
        });
        let (tone, words) = match (self.failures.len(), self.checks) {
            (0, 0) => (Tone::Good, "No claim failed.".into()),
            (0, checks) => (Tone::Good, format!("Every claim that was checked holds: {checks} of {checks}.")),
            (failed, _) => (Tone::Bad, format!("{failed} claims do not hold.")),
        };
        let list = |class: &str, items: &[String]| match items {
            [] => String::new(),
            items => format!("<ul class=\"{class}\"><li>{}</li></ul>\n", items.join("</li><li>")),
        };
        let found = tone.html(&words) + &list("failed", &self.failures) + &list("found", &self.conclusions);
        let turning = turned(&turning()?);
        let page = format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <title>polhode: results</title>\n<style>\n{STYLE}{VERDICT_STYLE}</style>\n</head>\n<body>\n\
             <h1>Integrators of rigid-body rotation: results</h1>\n\
             <p class=\"quiet\">polhode {}, {} scale</p>\n{found}<nav>\n{links}</nav>\n\
             <section id=\"verdict\">\n<h2>Which method is the quickest</h2>\n{verdict}</section>\n{turning}{}\
             <section id=\"provenance\">\n<h2>Provenance</h2>\n{}</section>\n\
             <script>\n{SCRIPT}</script>\n</body>\n</html>\n",
            env!("CARGO_PKG_VERSION"),
            self.scale,
            self.sections,
            self.runs,
        );
        self.output.write_whole(&page)
    }
}

/// Who is the quickest, in a sentence and by kind of problem.
fn verdict(costs: &Table) -> Result<String, Error> {
    let which = Which::of(&costs.csv()).map_err(|reason| Error::Failed(format!("costs: {reason}")))?;
    Ok(format!("<p>{}</p>\n{}", escaped(&which.claim()), titled(&which.table())))
}

/// Refuses a name that does not end in .html.
pub(super) fn is_page(path: &Path) -> Result<(), Error> {
    if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("html")) {
        return Ok(());
    }
    let value = path.display().to_string();
    Err(Error::input("--report", &value, "the report is a page", "end its name in .html"))
}

/// A table under its caption.
fn titled(table: &Table) -> String {
    format!("<h3>{}</h3>\n<div class=\"scroll\">\n{}</div>\n", escaped(&table.caption), table.html())
}

/// The polhode and the herpolhode, to turn.
fn turned(turning: &Turning) -> String {
    let numbers = |values: [f64; 3]| values.map(|x| x.to_string().replace('-', "−")).join(", ");
    let canvas = |id: &str, caption: &str, curves: &[turning::Curve]| {
        let curves = serde_json::to_string(curves).unwrap_or_default();
        format!(
            "<figure>\n<canvas tabindex=\"0\" data-curves=\"{id}-curves\" role=\"img\" aria-label=\"{caption}\"></canvas>\n\
             <figcaption>{caption}</figcaption>\n\
             <script type=\"application/json\" id=\"{id}-curves\">{curves}</script>\n</figure>\n"
        )
    };
    format!(
        "<section id=\"turn\">\n<h2>A polhode and a herpolhode to turn</h2>\n\
         <p>The body {} of the catalogue, moments {}, angular velocity {} rad/s in the body. Drag, or use the arrow keys.</p>\n\
         <div class=\"turning\">\n{}{}</div>\n</section>\n",
        turning.name,
        numbers(turning.moments),
        numbers(turning.omega_body),
        canvas(
            "polhode",
            "Directions of the angular momentum in the body: this motion, others with the same angular momentum, and the separatrix.",
            &turning.polhode
        ),
        canvas(
            "herpolhode",
            "The tip of the angular velocity in space: it stays in a plane across the angular momentum L.",
            &turning.herpolhode
        ),
    )
}
