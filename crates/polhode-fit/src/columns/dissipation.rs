//! Which columns take energy: the conditions that drag sets.

use crate::columns::column::Column;
use crate::columns::effect::Class;
use crate::physical::dissipation::Dissipation;

/// The conditions by which the columns `kept` take energy, as far as they are drag.
pub(crate) fn dissipation(columns: &[Column], kept: &[usize]) -> Vec<Dissipation> {
    let of = |place: usize| &columns[kept[place]];
    let drags: Vec<usize> = (0..kept.len()).filter(|&place| of(place).class() == Class::Drag).collect();
    // the columns of one segment stand together
    let groups = drags.chunk_by(|&a, &b| of(a).segment == of(b).segment);
    let conditions = |group: &[usize]| {
        let segment = of(group[0]).segment;
        if let Ok(places) = <[usize; 6]>::try_from(group) {
            return vec![Dissipation::Matrix { places, segment }];
        }
        let alone = |&place: &usize| {
            let name = of(place).label().name;
            Dissipation::Coefficient { place, name, segment }
        };
        group.iter().map(alone).collect()
    };
    groups.flat_map(conditions).collect()
}
