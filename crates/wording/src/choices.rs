//! Names of choices, and values that files leave out.

/// Whether a field has its default: files leave it out then.
pub fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// Names the choices of an enumeration in one place: `ALL` and `NAMES` in the order of tables, `name` and `named`, and
/// the same names in files (serde) and in their JSON Schemas.
#[macro_export]
macro_rules! words {
    ($kind:ident: $($variant:ident $word:literal),+ $(,)?) => {
        #[allow(dead_code, reason = "few enumerations need all of them")]
        impl $kind {
            /// All choices, in the order of tables.
            pub const ALL: [Self; [$($word),+].len()] = [$(Self::$variant),+];

            /// The names of all, in the order of tables.
            pub const NAMES: [&'static str; Self::ALL.len()] = [$($word),+];

            /// Name in files, records and tables.
            #[inline]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$variant => $word),+ }
            }

            /// The choice with a name.
            pub fn named(name: &str) -> Option<Self> {
                Self::ALL.into_iter().find(|choice| choice.name() == name)
            }
        }

        impl $crate::serde::Serialize for $kind {
            fn serialize<S: $crate::serde::Serializer>(&self, out: S) -> Result<S::Ok, S::Error> {
                out.serialize_str(self.name())
            }
        }

        impl<'de> $crate::serde::Deserialize<'de> for $kind {
            fn deserialize<D: $crate::serde::Deserializer<'de>>(input: D) -> Result<Self, D::Error> {
                use $crate::serde::de::Error;
                let name = <String as $crate::serde::Deserialize>::deserialize(input)?;
                Self::named(&name).ok_or_else(|| D::Error::unknown_variant(&name, &Self::NAMES))
            }
        }

        impl $crate::schemars::JsonSchema for $kind {
            fn inline_schema() -> bool {
                true
            }
            fn schema_name() -> std::borrow::Cow<'static, str> {
                stringify!($kind).into()
            }
            fn json_schema(_: &mut $crate::schemars::SchemaGenerator) -> $crate::schemars::Schema {
                $crate::schemars::json_schema!({ "type": "string", "enum": Self::NAMES })
            }
        }
    };
}
