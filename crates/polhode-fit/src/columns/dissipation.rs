//! Which columns take energy: the conditions that drag sets.

use crate::columns::column::Column;
use crate::columns::effect::Class;
use crate::physical::dissipation::Dissipation;

/// The conditions by which the columns `kept` take energy, as far as they are drag.
pub(crate) fn dissipation(columns: &[Column], kept: &[usize]) -> Vec<Dissipation> {
    let each = kept.iter().enumerate().filter(|(_, column)| columns[**column].class() == Class::Drag);
    each.map(|(place, column)| Dissipation { place, name: columns[*column].label().name }).collect()
}
