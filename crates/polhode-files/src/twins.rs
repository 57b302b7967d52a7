//! Left and right of a robot.

use std::collections::HashMap;

use crate::given::Given;
use polhode::inertia::Twin;

/// Words in the names of mirrored links.
const SIDES: [(&str, &str); 8] = [
    ("left", "right"),
    ("Left", "Right"),
    ("LEFT", "RIGHT"),
    ("l_", "r_"),
    ("L_", "R_"),
    ("_l", "_r"),
    ("_L", "_R"),
    ("FL", "FR"),
];

/// Links with the twin that their names point to. Only stated tensors have one: those computed here cannot be mistyped.
#[must_use]
pub fn paired(mut links: Vec<Given>) -> Vec<Given> {
    let is_stated = |link: &Given| link.writing.is_some() && !link.massless && link.defect.is_none();
    let places: HashMap<String, usize> = links
        .iter()
        .enumerate()
        .filter(|(_, link)| is_stated(link))
        .map(|(k, link)| (link.name.clone(), k))
        .collect();
    let twin = |link: &Given| {
        let names = SIDES.iter().flat_map(|(left, right)| {
            [link.name.replacen(left, right, 1), link.name.replacen(right, left, 1)]
        });
        let other = names.filter(|name| *name != link.name).find_map(|name| places.get(&name))?;
        let other = &links[*other];
        // in the axes of the same kind of frame
        (other.turn == link.turn).then(|| Twin {
            center_of_mass: other.turn.inverse() * other.center_of_mass,
            tensor: other.tensor,
        })
    };
    let twins: Vec<Option<Twin>> =
        links.iter().map(|link| if is_stated(link) { twin(link) } else { None }).collect();
    links.iter_mut().zip(twins).for_each(|(link, twin)| link.twin = twin);
    links
}
