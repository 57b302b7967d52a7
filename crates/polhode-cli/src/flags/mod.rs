//! Flags that several commands share.

pub(crate) mod attitude;
pub(crate) mod body;
pub(crate) mod event;
pub(crate) mod force;
pub(crate) mod motion;
pub(crate) mod record;
pub(crate) mod start;
pub(crate) mod table;
pub(crate) mod times;
pub(crate) mod tumbling;
pub(crate) mod wheel;
