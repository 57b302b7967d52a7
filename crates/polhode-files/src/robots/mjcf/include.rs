//! Included files.

use std::path::{Path, PathBuf};

use super::super::depth;
use super::super::element::Element;
use super::{Given, link};
use crate::read::read;

/// Files that one model may include.
const MOST_FILES: usize = 1000;
/// Bytes of them all.
const MOST_BYTES: usize = 1 << 28;

/// The model with every include replaced by what it names, and a row for each that cannot be.
pub(super) fn resolve(document: Element, path: &Path, root: Option<&Path>) -> (Element, Vec<Given>) {
    let folder = folder_of(path).to_path_buf();
    let allowed = root.map_or_else(|| folder.clone(), Path::to_path_buf);
    let open = path.canonicalize().into_iter().collect();
    let mut includes = Includes { folder, allowed, files: 0, bytes: 0, open, refused: Vec::new() };
    let document = includes.resolve(document, 0);
    (document, includes.refused)
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

struct Includes {
    /// Of the model, which the names are relative to.
    folder: PathBuf,
    /// What they may not leave.
    allowed: PathBuf,
    files: usize,
    bytes: usize,
    /// The files that are being read, the innermost last.
    open: Vec<PathBuf>,
    refused: Vec<Given>,
}

impl Includes {
    /// `element` stands at `depth`.
    fn resolve(&mut self, mut element: Element, depth: usize) -> Element {
        let children = std::mem::take(&mut element.children);
        for child in children {
            if child.tag == "include" {
                match self.included(&child, depth) {
                    Ok(found) => element.children.extend(found),
                    Err(defect) => {
                        let name = format!("include {}", child.attribute("file").unwrap_or_default());
                        self.refused.push(link(&name, &child, Err(child.error(&defect))));
                    }
                }
            } else {
                let resolved = self.resolve(child, depth + 1);
                element.children.push(resolved);
            }
        }
        element
    }

    /// What stands in an included file, its own includes replaced.
    fn included(&mut self, include: &Element, depth: usize) -> Result<Vec<Element>, String> {
        let name = include.attribute("file").ok_or("file is missing")?;
        // as MuJoCo looks for it, or else beside the file that includes it
        let place = [self.folder.join(name), folder_of(&include.file).join(name)]
            .into_iter()
            .find(|place| place.is_file())
            .ok_or_else(|| format!("file '{name}' is not there"))?;
        let real = |path: &Path| path.canonicalize().map_err(|error| format!("file '{name}': {error}"));
        let (found, allowed) = (real(&place)?, real(&self.allowed)?);
        if !found.starts_with(&allowed) {
            return Err(format!(
                "file '{name}' is outside of the folder of the model; if it is to be read, name a folder around both by --root"
            ));
        }
        if self.open.contains(&found) {
            return Err(format!("file '{name}' includes itself"));
        }
        self.files += 1;
        let size = found.metadata().map_or(0, |data| data.len());
        if self.files > MOST_FILES || size > MOST_BYTES.saturating_sub(self.bytes) as u64 {
            return Err(format!("more than {MOST_FILES} files or {MOST_BYTES} bytes are included"));
        }
        let text = read(&place, "name an MJCF file").map_err(|error| error.to_string())?;
        self.bytes += text.len();
        let document = Element::parse(&place, &text).map_err(|error| error.to_string())?;
        // each file alone is shallow, and a chain of them need not be
        if depth + document.depth() > depth::MOST {
            return Err(format!("file '{name}': elements would be nested more than {} deep", depth::MOST));
        }
        self.open.push(found);
        let mut children = Vec::new();
        for root in document.children {
            // a file of one element around others is opened; a bare one stands for itself
            if matches!(root.tag.as_str(), "mujoco" | "mujocoinclude") {
                children.extend(self.resolve(root, depth).children);
            } else {
                let holder = Element::around(vec![root], include.file.clone());
                children.extend(self.resolve(holder, depth).children);
            }
        }
        self.open.pop();
        Ok(children)
    }
}
