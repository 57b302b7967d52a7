//! Defaults classes.

use std::collections::HashMap;

use super::super::element::{Element, Value};
use super::orientation::ATTRIBUTES;

/// What classes say of geoms and meshes.
pub(super) struct Defaults<'e> {
    classes: HashMap<&'e str, Class<'e>>,
}

#[derive(Default)]
struct Class<'e> {
    parent: Option<&'e str>,
    /// Elements of the class itself, the first one first.
    own: Vec<&'e Element>,
}

/// Longest chain of classes; a longer one runs in a circle.
const DEEPEST: usize = 1000;

impl<'e> Defaults<'e> {
    /// Of the `<default>` elements of a model, whose outermost class is called main.
    pub(super) fn of(document: &'e Element) -> Self {
        let mut found = Defaults { classes: HashMap::new() };
        found.collect(document, None);
        found
    }

    fn collect(&mut self, element: &'e Element, parent: Option<&'e str>) {
        for child in &element.children {
            if child.tag == "default" {
                let name = match parent {
                    None => child.attribute("class").filter(|name| *name != "main").unwrap_or("main"),
                    Some(_) => child.attribute("class").unwrap_or_default(),
                };
                // the outermost class is main, whatever else it is called
                let outer = parent.or((name != "main").then_some("main"));
                let class = self.classes.entry(name).or_default();
                class.parent = outer;
                class.own.extend(child.children.iter().filter(|child| child.tag != "default"));
                self.collect(child, Some(name));
            } else if parent.is_none() {
                self.collect(child, None);
            }
        }
    }

    pub(super) fn has(&self, class: &str) -> bool {
        class == "main" || self.classes.contains_key(class)
    }

    /// The value of `attribute` of `element`, or that of its class.
    ///
    /// An orientation of its own hides every inherited one, however either is written.
    pub(super) fn value(
        &self,
        element: &'e Element,
        class: &str,
        attribute: &str,
    ) -> Option<(&'e Element, &'e Value)> {
        self.levels(element, class).find_map(|level| level.value(attribute).map(|value| (level, value)))
    }

    /// The element that says how `element` is turned.
    pub(super) fn turned(&self, element: &'e Element, class: &str) -> Option<&'e Element> {
        self.levels(element, class)
            .find(|level| ATTRIBUTES.iter().any(|attribute| level.attribute(attribute).is_some()))
    }

    /// The element itself, then those of its class and of the classes around it.
    pub(super) fn levels(&self, element: &'e Element, class: &str) -> impl Iterator<Item = &'e Element> {
        let mut found = vec![element];
        let mut next = self.classes.get(class).or_else(|| self.classes.get("main"));
        let mut depth = 0;
        while let Some(level) = next {
            found.extend(level.own.iter().rev().filter(|own| own.tag == element.tag));
            depth += 1;
            next = level.parent.filter(|_| depth < DEEPEST).and_then(|parent| self.classes.get(parent));
        }
        found.into_iter()
    }
}
