//! The files that a fit writes: checked and opened before the work, written after it.

use std::path::Path;

use polhode_files::error::Error;
use polhode_files::inputs;
use polhode_fit::{Estimate, FitError, FittedMotion, Method, Record};
use polhode_pages::document::Form;
use polhode_pages::output::Output;
use polhode_pages::table::Format;

use super::as_read::AsRead;
use super::flights::Spans;
use super::{Fit, page, plot, refusal, residuals};
use crate::plot::{Picture, write};

/// Where an answer goes.
pub(super) struct Outputs {
    pub(super) output: Output,
    pub(super) page: Option<(Output, Form)>,
    pub(super) residuals: Option<Output>,
    pub(super) figure: Option<(Output, Picture)>,
}

/// Whether the name of a file has one of these endings, in letters of any size.
fn ends_in(path: &Path, endings: &[&str]) -> bool {
    let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
    endings.iter().any(|known| ending.eq_ignore_ascii_case(known))
}

impl Fit {
    /// No sample is read twice, and no measurement is written over.
    pub(super) fn check_paths(&self) -> Result<(), Error> {
        let same = |a: &Path, b: &Path| {
            let whole = |path: &Path| path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
            whole(a) == whole(b)
        };
        let files = self.files();
        for (k, path) in files.iter().enumerate() {
            if files[..k].iter().any(|before| same(before, path)) {
                let value = path.display().to_string();
                return Err(Error::input(
                    "DATA",
                    &value,
                    "the file is given twice",
                    "give it once, with windows",
                ));
            }
        }
        let written = [
            ("--out", &self.out),
            ("--residuals", &self.residuals),
            ("--report", &self.report),
            ("--figure", &self.figure),
        ];
        for (k, (flag, out)) in written.iter().enumerate() {
            let Some(out) = out else { continue };
            let twice = written[..k].iter().find(|(_, other)| other.as_ref().is_some_and(|o| same(o, out)));
            if let Some((other, _)) = twice {
                let value = out.display().to_string();
                return Err(Error::input(
                    flag,
                    &value,
                    &format!("it would replace {other}"),
                    "name another file",
                ));
            }
        }
        // refused before the work rather than at its end
        files.iter().for_each(|path| inputs::register(path));
        if let Some(path) = self
            .residuals
            .as_deref()
            .filter(|path| path.extension().is_some() && !ends_in(path, &["svg", "png", "csv"]))
        {
            let value = path.display().to_string();
            let rule = "residuals are written as SVG, PNG or CSV";
            return Err(Error::input("--residuals", &value, rule, "let the name end in .svg, .png or .csv"));
        }
        Ok(())
    }

    pub(super) fn outputs(&self) -> Result<Outputs, Error> {
        let form = self.report.as_deref().map(|path| Form::of("--report", path)).transpose()?;
        let output = Output::new(self.out.as_deref())?;
        let residuals = self.residuals.as_deref().map(|path| Output::to_file("--residuals", path));
        let residuals = residuals.transpose()?;
        let page = self.report.as_deref().map(|path| Output::to_file("--report", path)).transpose()?;
        let figure = self.figure.as_deref().map(|path| {
            let picture = Picture::of("--figure", path, &[Picture::Svg, Picture::Png])?;
            Ok::<_, Error>((Output::to_file("--figure", path)?, picture))
        });
        Ok(Outputs { output, page: page.zip(form), residuals, figure: figure.transpose()? })
    }

    /// Writes what a record without an answer tells all the same, and gives the error that the fit ends with.
    pub(super) fn refused(
        &self,
        error: &FitError,
        (record, as_read, spans): (&Record, &AsRead, &Spans),
        (method, format): (Method, Format),
        (output, page): (Output, Option<(Output, Form)>),
    ) -> Result<Error, Error> {
        let reason = refusal::reason(error);
        let (facts, failed) = refusal::facts(error);
        if let Some((file, form)) = page {
            let read = (record, as_read);
            file.write_whole(&page::refused(&reason, facts.as_ref(), read, spans, &self.names(), form))?;
        }
        if let Some(facts) = facts {
            output.write_whole(&facts.report(record, spans, (as_read, &reason, method), format))?;
        }
        let message = format!("{}: {reason}", self.names());
        Ok(if failed { Error::Failed(message) } else { Error::Input(message) })
    }

    /// Writes residuals, as rows or drawn, and the figure.
    pub(super) fn draw(
        &self,
        (estimate, record, motion): (&Estimate, &Record, &[FittedMotion]),
        residuals: Option<Output>,
        figure: Option<(Output, Picture)>,
    ) -> Result<(), Error> {
        if let Some((file, path)) = residuals.zip(self.residuals.as_deref()) {
            if ends_in(path, &["csv"]) {
                let turns = estimate.attitudes.as_ref().map(|a| residuals::turns(estimate, a.noise_sigma));
                file.write_whole(&turns.unwrap_or_else(|| residuals::rows(record, motion)).csv())?;
            } else {
                let picture = if ends_in(path, &["png"]) { Picture::Png } else { Picture::Svg };
                write(file, picture, &plot::residuals(estimate).page())?;
            }
        }
        if let Some((file, picture)) = figure {
            write(file, picture, &page::figures::overview(estimate, motion, record))?;
        }
        Ok(())
    }
}
