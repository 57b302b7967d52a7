//! A document of a few kinds of parts, as HTML and as Markdown.

use std::fmt::Write as _;
use std::path::Path;

use polhode_files::error::Error;
use polhode_files::text::escaped_html as escaped;

/// How a document is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// A page for browsers.
    Html,
    /// Plain text.
    Markdown,
}

impl Form {
    /// By the ending of the file that `flag` names.
    pub fn of(flag: &str, path: &Path) -> Result<Self, Error> {
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        match ending.as_deref() {
            Some("html" | "htm") => Ok(Self::Html),
            Some("md" | "markdown") => Ok(Self::Markdown),
            _ => {
                let value = path.display().to_string();
                Err(Error::input(
                    flag,
                    &value,
                    "a page is HTML or Markdown",
                    "let the name end in .html or .md",
                ))
            }
        }
    }

    /// The text of the document.
    pub fn write(self, title: &str, parts: &[Block]) -> String {
        match self {
            Self::Html => html(title, parts),
            Self::Markdown => markdown(title, parts),
        }
    }
}

/// How a verdict is meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tone {
    /// It holds.
    Good,
    /// It is open, or holds with doubts.
    Doubtful,
    /// It does not hold.
    Bad,
}

impl Tone {
    /// Its class and its sign: each has a shape of its own beside its colour.
    fn looks(self) -> (&'static str, &'static str) {
        match self {
            Self::Good => ("good", "\u{2714}"),
            Self::Doubtful => ("doubtful", "\u{25b2}"),
            Self::Bad => ("bad", "\u{2716}"),
        }
    }

    /// `words`, plain text, large, as HTML for a page with [`VERDICT_STYLE`].
    #[must_use]
    pub fn html(self, words: &str) -> String {
        let (class, sign) = self.looks();
        format!(
            "<p class=\"verdict {class}\"><span aria-hidden=\"true\">{sign}</span> {}</p>\n",
            escaped(words)
        )
    }
}

/// What [`Tone::html`] needs.
pub const VERDICT_STYLE: &str = ".verdict{font-size:1.5rem;font-weight:600;line-height:1.3;margin:1rem 0;padding:.6rem .9rem;border:2px solid;border-radius:6px;overflow-wrap:anywhere}\
.verdict.good{color:#00573f;background:#e3f5ee}.verdict.doubtful{color:#6b4500;background:#fdf3da;border-style:dashed}.verdict.bad{color:#8c1d00;background:#fdeae4;border-style:double;border-width:5px}";

/// A part.
pub enum Block {
    /// What a page is about, large.
    Verdict(Tone, String),
    /// Of a chapter.
    Heading(String),
    /// Plain text.
    Paragraph(String),
    /// Points, one below the other.
    List(Vec<String>),
    /// Head and rows; the first column is text, the others numbers.
    Table(Vec<String>, Vec<Vec<String>>),
    /// A drawing, and what it shows.
    Figure(String, String),
}

pub(crate) const STYLE: &str = "body{font:16px/1.5 sans-serif;max-width:60rem;margin:2rem auto;padding:0 1rem;color:#111;background:#fff}\
h1{font-size:1.5rem}h2{font-size:1.15rem;margin-top:2rem}\
table{display:block;overflow-x:auto;border-collapse:collapse;margin:1rem 0}td,th{padding:.2rem .7rem;text-align:right;border-bottom:1px solid #ddd}\
td:first-child,th:first-child{text-align:left}td{font-variant-numeric:tabular-nums}\
figure{margin:1rem 0}figure svg{max-width:100%;height:auto}figcaption{font-size:.9rem;color:#444}\
.warning{border-left:4px solid #d55e00;padding-left:.8rem}";

fn html(title: &str, parts: &[Block]) -> String {
    let title = escaped(title);
    let mut text = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{title}</title>\n<style>{STYLE}{VERDICT_STYLE}</style>\n</head>\n<body>\n<h1>{title}</h1>\n"
    );
    for part in parts {
        let _ = match part {
            Block::Verdict(tone, words) => write!(text, "{}", tone.html(words)),
            Block::Heading(heading) => writeln!(text, "<h2>{}</h2>", escaped(heading)),
            Block::Paragraph(words) => writeln!(text, "<p>{}</p>", escaped(words)),
            Block::List(items) => {
                let items: String = items.iter().map(|i| format!("<li>{}</li>\n", escaped(i))).collect();
                writeln!(text, "<ul class=\"warning\">\n{items}</ul>")
            }
            Block::Table(head, rows) => {
                let row = |cells: &[String], tag: &str| {
                    let cells: String =
                        cells.iter().map(|c| format!("<{tag}>{}</{tag}>", escaped(c))).collect();
                    format!("<tr>{cells}</tr>\n")
                };
                let rows: String = rows.iter().map(|cells| row(cells, "td")).collect();
                writeln!(
                    text,
                    "<table>\n<thead>{}</thead>\n<tbody>\n{rows}</tbody>\n</table>",
                    row(head, "th")
                )
            }
            Block::Figure(svg, caption) => writeln!(
                text,
                "<figure role=\"img\" aria-label=\"{0}\">\n{svg}\n<figcaption>{0}</figcaption>\n</figure>",
                escaped(caption)
            ),
        };
    }
    text + "</body>\n</html>\n"
}

/// Drawings stand in it as SVG, which Markdown passes on.
fn markdown(title: &str, parts: &[Block]) -> String {
    let mut text = format!("# {title}\n");
    for part in parts {
        let _ = match part {
            Block::Verdict(tone, words) => writeln!(text, "\n**{} {words}**", tone.looks().1),
            Block::Heading(heading) => writeln!(text, "\n## {heading}"),
            Block::Paragraph(words) => writeln!(text, "\n{words}"),
            Block::List(items) => {
                let items: String = items.iter().map(|item| format!("- {item}\n")).collect();
                write!(text, "\n{items}")
            }
            Block::Table(head, rows) => {
                let row = |cells: &[String]| {
                    let cells: Vec<String> = cells.iter().map(|c| c.replace('|', "\\|")).collect();
                    format!("| {} |\n", cells.join(" | "))
                };
                let rule: Vec<String> =
                    (0..head.len()).map(|k| if k == 0 { ":---" } else { "---:" }.into()).collect();
                let rows: String = rows.iter().map(|cells| row(cells)).collect();
                write!(text, "\n{}{}{rows}", row(head), row(&rule))
            }
            Block::Figure(svg, caption) => {
                let lines: String = svg.lines().filter(|line| !line.trim().is_empty()).collect();
                writeln!(text, "\n<figure>{lines}</figure>\n\n{caption}")
            }
        };
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_forms_hold_every_part_and_no_text_is_markup() {
        let parts = [
            Block::Verdict(Tone::Bad, "wrong & late".into()),
            Block::Heading("a < b".into()),
            Block::Paragraph("c & d".into()),
            Block::List(vec!["\"e\"".into()]),
            Block::Table(vec!["name".into(), "x|y".into()], vec![vec!["f".into(), "1".into()]]),
            Block::Figure("<svg>\n\n</svg>".into(), "g".into()),
        ];
        let page = html("t", &parts);
        for piece in [
            "verdict bad",
            "wrong &amp; late",
            "<h2>a &lt; b</h2>",
            "c &amp; d",
            "&quot;e&quot;",
            "<td>f</td><td>1</td>",
            "<svg>",
        ] {
            assert!(page.contains(piece), "{piece}: {page}");
        }
        let page = markdown("t", &parts);
        for piece in [
            "wrong & late**",
            "## a < b",
            "- \"e\"",
            "| name | x\\|y |\n| :--- | ---: |\n| f | 1 |",
            "<svg></svg>",
        ] {
            assert!(page.contains(piece), "{piece}: {page}");
        }
    }
}
