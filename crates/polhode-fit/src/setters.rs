//! Chained setters of public structs: a new field then breaks no caller.

/// Setters of the fields that are listed, `with_` and the name; those of an `Option` take the option or its value.
macro_rules! setters {
    (options { $($option:ident => $set_option:ident($inner:ty)),* $(,)? } values { $($value:ident => $set_value:ident($kind:ty)),* $(,)? }) => {
        $(
            #[doc = concat!("With another [`", stringify!($option), "`](Self::", stringify!($option), ").")]
            #[must_use]
            pub fn $set_option(mut self, $option: impl Into<Option<$inner>>) -> Self {
                self.$option = $option.into();
                self
            }
        )*
        $(
            #[doc = concat!("With another [`", stringify!($value), "`](Self::", stringify!($value), ").")]
            #[must_use]
            pub fn $set_value(mut self, $value: $kind) -> Self {
                self.$value = $value;
                self
            }
        )*
    };
}

pub(crate) use setters;
