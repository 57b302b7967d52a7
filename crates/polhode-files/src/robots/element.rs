//! An XML file as a tree that knows where everything stands in it.

use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use roxmltree::{Document, Node, NodeType};

use crate::error::Error;
use crate::numbers::number;
use crate::text::visible;

/// Prefixes without a declaration that one file may have.
const MOST_PREFIXES: usize = 64;

/// A text of the file and the bytes that hold it.
#[derive(Clone, Debug)]
pub struct Value {
    /// The text.
    pub text: String,
    /// Its bytes.
    pub range: Range<usize>,
}

/// An element with what stands in it.
#[derive(Clone, Debug)]
pub(super) struct Element {
    /// With its prefix, if it has one.
    pub(super) tag: String,
    attributes: Vec<(String, Value)>,
    pub(super) children: Vec<Element>,
    /// The text of an element that has nothing else.
    pub(super) text: Option<Value>,
    pub(super) file: Arc<Path>,
    line: usize,
}

impl Element {
    /// The elements of a file, below one that has no name: fragments may stand side by side.
    ///
    /// Prefixes need no declaration. Document types are refused, and with them entities.
    ///
    /// # Errors
    /// Text that is no XML; elements nested deeper than models ever are, which would exhaust the stack.
    pub(super) fn parse(path: &Path, text: &str) -> Result<Element, Error> {
        super::depth::check(path, text)?;
        let mut namespaces = String::new();
        let blank = blank_declaration(text);
        for _ in 0..MOST_PREFIXES {
            let head = format!("<fragments{namespaces}>");
            let wrapped = format!("{head}{blank}</fragments>");
            match Document::parse(&wrapped) {
                Ok(document) => {
                    let lines = Lines::of(text);
                    let reader = Reader { file: path.into(), lines, head: head.len() };
                    return Ok(reader.element(document.root_element()));
                }
                Err(roxmltree::Error::UnknownNamespace(prefix, _))
                    if !namespaces.contains(&format!("\"{UNDECLARED}{prefix}\"")) =>
                {
                    namespaces += &format!(" xmlns:{prefix}=\"{UNDECLARED}{prefix}\"");
                }
                // with the places of the file itself, where it is one document
                Err(error) => return Err(refusal(path, text, &error)),
            }
        }
        Err(Error::Input(format!("{}: more than {MOST_PREFIXES} undeclared prefixes", path.display())))
    }

    /// An element without a name around others.
    pub(super) fn around(children: Vec<Element>, file: Arc<Path>) -> Element {
        Element { tag: String::new(), attributes: Vec::new(), children, text: None, file, line: 1 }
    }

    pub(super) fn named<'e>(&'e self, tag: &'static str) -> impl Iterator<Item = &'e Element> {
        self.children.iter().filter(move |child| child.tag == tag)
    }

    pub(super) fn child(&self, tag: &'static str) -> Option<&Element> {
        self.named(tag).next()
    }

    /// The one child of this tag, if there is one: of two it is not said which counts.
    pub(super) fn single(&self, tag: &'static str) -> Result<Option<&Element>, String> {
        let mut named = self.named(tag);
        match (named.next(), named.next()) {
            (_, Some(second)) => Err(second.error("is given twice; leave one out")),
            (first, None) => Ok(first),
        }
    }

    pub(super) fn value(&self, attribute: &str) -> Option<&Value> {
        self.attributes.iter().find(|(name, _)| name == attribute).map(|(_, value)| value)
    }

    pub(super) fn attribute(&self, attribute: &str) -> Option<&str> {
        self.value(attribute).map(|value| value.text.as_str())
    }

    /// Refuses an attribute without a prefix that is none of these.
    pub(super) fn only(&self, known: &[&str]) -> Result<(), String> {
        let is_other = |name: &&str| !known.contains(name) && !name.contains(':');
        match self.attributes.iter().map(|(name, _)| name.as_str()).find(is_other) {
            Some(name) => Err(self.error(&format!("{name} is not read here; known: {}", known.join(", ")))),
            None => Ok(()),
        }
    }

    /// Which element in it is none of these, in words.
    pub(super) fn unread(&self, known: &[&str]) -> Option<String> {
        let is_other = |child: &&Element| !known.contains(&child.tag.as_str()) && !child.tag.contains(':');
        self.children.iter().find(is_other).map(|child| child.error("is not read here"))
    }

    /// This element and all below it, in the order of the file.
    pub(super) fn all(&self) -> Vec<&Element> {
        let mut found = vec![self];
        for child in &self.children {
            found.extend(child.all());
        }
        found
    }

    /// Elements inside each other, this one among them.
    pub(super) fn depth(&self) -> usize {
        1 + self.children.iter().map(Element::depth).max().unwrap_or(0)
    }

    /// The numbers of an attribute, if it is there.
    pub(super) fn optional<const N: usize>(&self, attribute: &str) -> Result<Option<[f64; N]>, String> {
        let Some(text) = self.attribute(attribute) else { return Ok(None) };
        exactly(text).map(Some).map_err(|error| self.error(&format!("{attribute}: {error}")))
    }

    pub(super) fn needed<const N: usize>(&self, attribute: &str) -> Result<[f64; N], String> {
        self.optional(attribute)?.ok_or_else(|| self.error(&format!("{attribute} is missing")))
    }

    /// The numbers between the tags.
    pub(super) fn content<const N: usize>(&self) -> Result<[f64; N], String> {
        let text = self.text.as_ref().map_or("", |value| value.text.as_str());
        exactly(text).map_err(|error| self.error(&error))
    }

    /// `message` with the file, the line and the element.
    pub(super) fn error(&self, message: &str) -> String {
        visible(&format!("{}: <{}>: {message}", self.place(), self.tag)).into()
    }

    pub(super) fn place(&self) -> String {
        format!("{}:{}", self.file.display(), self.line)
    }
}

/// All numbers of a text, separated by blanks.
pub(super) fn list(text: &str) -> Result<Vec<f64>, String> {
    text.split_whitespace().map(number).collect()
}

fn exactly<const N: usize>(text: &str) -> Result<[f64; N], String> {
    let numbers = list(text)?;
    let found = numbers.len();
    numbers.try_into().map_err(|_| format!("{found} given, {N} needed, separated by blanks"))
}

/// Before the prefix in the name of a namespace that the file does not declare.
const UNDECLARED: &str = "undeclared:";

/// The text with `<?xml …?>` blanked, byte for byte: it may stand only at the head of a document, and in files it stands elsewhere.
fn blank_declaration(text: &str) -> String {
    let mut blank = text.replace('\u{feff}', "   ");
    let mut from = 0;
    while let Some(start) = blank[from..].find("<?xml ").map(|at| from + at) {
        let Some(end) = blank[start..].find("?>").map(|at| start + at + 2) else { break };
        let spaces: String =
            blank[start..end].bytes().map(|byte| if byte == b'\n' { '\n' } else { ' ' }).collect();
        blank.replace_range(start..end, &spaces);
        from = end;
    }
    blank
}

fn refusal(path: &Path, text: &str, wrapped: &roxmltree::Error) -> Error {
    if text.contains("<!DOCTYPE") {
        let rule = "it has a document type, and entities are not expanded";
        return Error::input(&path.display().to_string(), "", rule, "remove <!DOCTYPE ...>");
    }
    let error = match Document::parse(text) {
        Err(error) => error.to_string(),
        Ok(_) => wrapped.to_string(),
    };
    Error::Input(visible(&format!("{}: {error}", path.display())).into())
}

/// Where the lines of a text begin.
struct Lines(Vec<usize>);

impl Lines {
    fn of(text: &str) -> Self {
        let ends = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n');
        Lines(std::iter::once(0).chain(ends.map(|(at, _)| at + 1)).collect())
    }

    /// The line of a byte, from 1.
    fn of_byte(&self, at: usize) -> usize {
        self.0.partition_point(|start| *start <= at)
    }
}

struct Reader {
    file: Arc<Path>,
    lines: Lines,
    /// Bytes before the text of the file.
    head: usize,
}

impl Reader {
    fn element(&self, node: Node<'_, '_>) -> Element {
        let value = |text: &str, range: Range<usize>| Value {
            text: text.into(),
            range: range.start.saturating_sub(self.head)..range.end.saturating_sub(self.head),
        };
        let attributes = node.attributes().map(|found| {
            let name = match found.namespace() {
                Some(_) => format!(":{}", found.name()),
                None => found.name().to_owned(),
            };
            (name, value(found.value(), found.range_value()))
        });
        let children: Vec<Element> =
            node.children().filter(Node::is_element).map(|child| self.element(child)).collect();
        let mut texts = node.children().filter(|child| child.node_type() == NodeType::Text);
        let text = match (texts.next(), texts.next()) {
            (Some(only), None) if children.is_empty() => only.text().map(|text| value(text, only.range())),
            _ => None,
        };
        Element {
            tag: self.tag(node),
            attributes: attributes.collect(),
            children,
            text,
            file: self.file.clone(),
            line: self.lines.of_byte(node.range().start.saturating_sub(self.head)),
        }
    }

    /// An element of another language keeps its prefix, so that it is not taken for one of ours.
    fn tag(&self, node: Node<'_, '_>) -> String {
        let name = node.tag_name();
        let prefix = name.namespace().and_then(|uri| match uri.strip_prefix(UNDECLARED) {
            Some(prefix) => Some(prefix),
            None => node.lookup_prefix(uri),
        });
        match prefix {
            Some(prefix) if !prefix.is_empty() => format!("{prefix}:{}", name.name()),
            _ => name.name().to_owned(),
        }
    }
}
