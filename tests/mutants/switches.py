"""Many mutants in one program: bodies of functions in as many copies as they have mutants.

A body `{ … }` becomes `{ match crate::mutant::number() { 7 => { … }, 9 => { … }, _ => { … } } }`, where 7 and 9 are copies that
`cargo mutants` changes at one place. The number is read from the environment once.
"""

import re

VARIABLE = "MUTANT"

SWITCH = f"""
#[doc(hidden)]
mod mutant {{
    pub(crate) fn number() -> u32 {{
        static NUMBER: std::sync::LazyLock<u32> =
            std::sync::LazyLock::new(|| std::env::var("{VARIABLE}").ok().and_then(|n| n.parse().ok()).unwrap_or(0));
        *NUMBER
    }}
}}
"""


class Source:
    """A file, and where in it a mutant is."""

    def __init__(self, text):
        self.text = text
        self.lines = [0]
        for line in text.splitlines(keepends=True):
            self.lines.append(self.lines[-1] + len(line))

    def span(self, span):
        return tuple(self.lines[at["line"] - 1] + at["column"] - 1 for at in (span["start"], span["end"]))

    def mutated(self, mutant, begin=0, end=None):
        """The part from `begin` to `end`, changed."""
        a, b = self.span(mutant["span"])
        return self.text[begin:a] + mutant["replacement"] + self.text[b : len(self.text) if end is None else end]

    def function(self, mutant):
        """Begin and end of the function that can be switched, and of its body; `None` of constants, which are worked out by the
        compiler, and of functions whose copies would return different types."""
        if mutant["function"] is None:
            return None
        begin, end = self.span(mutant["function"]["span"])
        head = re.search(r"\bfn\s+\w+", self.text[begin:end])
        depth, body = 0, begin + head.end()
        while depth > 0 or self.text[body] != "{":
            depth += {"(": 1, "[": 1, ")": -1, "]": -1}.get(self.text[body], 0)
            body += 1
        signature = self.text[begin:body]
        inside = self.span(mutant["span"])[0] >= body
        if not inside or re.search(r"\bconst\s+fn\b|->\s*impl\b", signature):
            return None
        return begin, end, body


def switched(source, mutants):
    """The text with all `mutants`, pairs of a number and a mutant, behind switches, and the lines of each copy: number, first,
    last."""
    functions = sorted({source.function(mutant) for _, mutant in mutants})
    outermost = [one for k, one in enumerate(functions) if all(one[1] > other[1] for other in functions[:k])]
    text, lines, done = "", [], 0
    for begin, end, body in outermost:
        text += source.text[done:body] + "{ match crate::mutant::number() { "
        for number, mutant in mutants:
            if begin <= source.span(mutant["span"])[0] < end:
                first = text.count("\n") + 1
                text += f"{number} => {source.mutated(mutant, body, end)}"
                lines.append((number, first, text.count("\n") + 1))
                text += ",\n"
        text += f"_ => {source.text[body:end]} }} }}"
        done = end
    return text + source.text[done:], lines
