//! The rounded rows in Markdown, HTML and LaTeX.

use polhode_files::text::{escaped_html, visible};

use super::rounded::rounded;
use super::{Cell, Column, Table};

impl Table {
    /// Rounded, as Markdown.
    pub fn markdown(&self) -> String {
        let shown = self.shown();
        let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
        let mut text = line(shown.iter().map(|(_, column)| escaped_markdown(&with_unit(column))).collect());
        let rules = shown.iter().map(|(k, _)| if self.is_numeric(*k) { "---:" } else { ":---" });
        text += &line(rules.map(String::from).collect());
        for row in self.rows() {
            let cell = |(k, column): &(usize, &Column)| match &row[*k] {
                Cell::Number(x) => rounded(*x, column.digits).plain(),
                other => escaped_markdown(&other.exact()),
            };
            text += &line(shown.iter().map(cell).collect());
        }
        text
    }

    /// A table whose heads are buttons to sort by; numbers have all their digits in `data-value`.
    pub fn html(&self) -> String {
        let shown = self.shown();
        let class = |k: usize| if self.is_numeric(k) { " class=\"number\"" } else { "" };
        let head = |(k, column): &(usize, &Column)| {
            let heading = escaped_html(&with_unit(column));
            format!("<th scope=\"col\"{}><button>{heading}</button></th>", class(*k))
        };
        let cell = |row: &[Cell], (k, column): &(usize, &Column)| match &row[*k] {
            Cell::Number(x) => {
                let text = rounded(*x, column.digits).plain();
                format!("<td{} data-value=\"{x:?}\">{text}</td>", class(*k))
            }
            other => format!("<td{}>{}</td>", class(*k), escaped_html(&visible(&other.exact()))),
        };
        let mut text = String::from("<table>\n<thead><tr>");
        text.extend(shown.iter().map(head));
        text += "</tr></thead>\n<tbody>\n";
        for row in self.rows() {
            text += "<tr>";
            text.extend(shown.iter().map(|column| cell(row, column)));
            text += "</tr>\n";
        }
        text + "</tbody>\n</table>\n"
    }

    /// A `tabular` in booktabs style, to be put into a `table` with its own caption.
    pub fn latex(&self) -> String {
        let shown = self.shown();
        let line = |cells: Vec<String>| format!("{} \\\\\n", cells.join(" & "));
        let alignment: String =
            shown.iter().map(|(k, _)| if self.is_numeric(*k) { 'r' } else { 'l' }).collect();
        let mut text = format!("\\begin{{tabular}}{{{alignment}}}\n\\toprule\n");
        text += &line(shown.iter().map(|(_, column)| latex_heading(column)).collect());
        text += "\\midrule\n";
        for row in self.rows() {
            let cell = |(k, column): &(usize, &Column)| match &row[*k] {
                Cell::Number(x) => rounded(*x, column.digits).latex(),
                Cell::Integer(n) => latex_count(*n),
                other => escaped_latex(&other.exact()),
            };
            text += &line(shown.iter().map(cell).collect());
        }
        text + "\\bottomrule\n\\end{tabular}\n"
    }
}

/// "step [s]"
pub(super) fn with_unit(column: &Column) -> String {
    match &*column.unit {
        "" => column.heading.to_string(),
        unit => format!("{} [{unit}]", column.heading),
    }
}

fn latex_heading(column: &Column) -> String {
    let heading = column.latex.as_deref().map_or_else(|| escaped_latex(&column.heading), str::to_string);
    match &*column.unit {
        "" => heading,
        unit => format!("{heading} [{}]", escaped_latex(unit)),
    }
}

/// Powers of ten as such from a hundred thousand on.
fn latex_count(n: i64) -> String {
    let power = n.checked_ilog10().filter(|power| *power >= 5 && 10_i64.checked_pow(*power) == Some(n));
    power.map_or_else(|| format!("${n}$"), |power| format!("$10^{{{power}}}$"))
}

fn escaped_markdown(text: &str) -> String {
    visible(&text.replace('|', "\\|").replace('<', "&lt;").replace('\n', " ")).into_owned()
}

fn escaped_latex(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in visible(&text.replace('\n', " ")).chars() {
        match c {
            '&' | '%' | '$' | '#' | '_' | '{' | '}' => escaped.extend(['\\', c]),
            '\\' => escaped += r"\textbackslash{}",
            '~' => escaped += r"\textasciitilde{}",
            '^' => escaped += r"\textasciicircum{}",
            '|' => escaped += r"\textbar{}",
            '<' => escaped += r"\textless{}",
            '>' => escaped += r"\textgreater{}",
            'Δ' => escaped += r"$\Delta$",
            'ω' => escaped += r"$\omega$",
            '⁻' => escaped += r"$^{-}$",
            '²' => escaped += r"\textsuperscript{2}",
            '¹' | '³' | '⁰' | '⁴'..='⁹' => {
                // all but three stand in the order of the digits
                let digit = match c {
                    '¹' => 1,
                    '³' => 3,
                    _ => c as u32 - '⁰' as u32,
                };
                escaped += &format!(r"\textsuperscript{{{digit}}}");
            }
            '·' => escaped += r"$\cdot$",
            '×' => escaped += r"$\times$",
            _ => escaped.push(c),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::super::tests::example;
    use super::*;

    #[test]
    fn markdown_of_the_shown_columns() {
        let expected = "| method | step [s] | max \\|ΔE/E\\| |\n| :--- | ---: | ---: |\n\
                        | rk4 | 0.01 | 4.3e-10 |\n| two, \"turns\" & 50 % | 0.3 |  |\n";
        assert_eq!(example().markdown(), expected);
    }

    #[test]
    fn html_of_the_shown_columns_sorts_by_all_digits() {
        let html = example().html();
        let row = "<tr><td>two, &quot;turns&quot; &amp; 50 %</td><td class=\"number\" data-value=\"0.30000000000000004\">0.3</td>\
                   <td class=\"number\"></td></tr>";
        assert!(html.contains(row), "{html}");
        assert!(html.contains("<th scope=\"col\" class=\"number\"><button>step [s]</button></th>"), "{html}");
    }

    #[test]
    fn latex_of_the_shown_columns() {
        let expected = r#"\begin{tabular}{lrr}
\toprule
method & step [s] & $|\Delta E/E|$ \\
\midrule
rk4 & $0.01$ & $4.3\times10^{-10}$ \\
two, "turns" \& 50 \% & $0.3$ &  \\
\bottomrule
\end{tabular}
"#;
        assert_eq!(example().latex(), expected);
    }

    #[test]
    fn latex_escapes_its_own_signs() {
        assert_eq!(escaped_latex(r"a_b\c^{2}"), r"a\_b\textbackslash{}c\textasciicircum{}\{2\}");
        assert_eq!(
            escaped_latex("|ΔE| < 10⁻¹⁶ rad/s²"),
            r"\textbar{}$\Delta$E\textbar{} \textless{} 10$^{-}$\textsuperscript{1}\textsuperscript{6} rad/s\textsuperscript{2}"
        );
    }
}
