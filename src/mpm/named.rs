//! Names of choices: every variant of an enum with its word in study files, in one line each.

/// Gives an enum the list of its variants and their names.
macro_rules! named {
    ($choice:ty { $($variant:ident = $name:literal),+ $(,)? }) => {
        impl $choice {
            /// Every choice, in the order of the documentation.
            pub const ALL: [Self; [$($name),+].len()] = [$(Self::$variant),+];

            /// Name in study files and records.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $name),+
                }
            }
        }
    };
}
pub(crate) use named;
