//! The laws, each in a file of its own: add another one by its file and its line here.

/// Files of laws with the variant and the word of each, in the order of tables.
macro_rules! laws {
    ($($file:ident $data:ident: $variant:ident $word:literal),+ $(,)?) => {
        $(mod $file;
        pub use $file::$data;)+

        /// A stress–strain law of the skeleton with the conductivity that goes with it, by its name.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum Law {
            $(#[doc = concat!("`", $word, "`.")]
            $variant),+
        }

        oedometer_wording::words!(Law: $($variant $word),+);

        impl Law {
            /// What it is.
            #[inline]
            pub const fn data(self) -> &'static crate::law_data::LawData {
                match self {
                    $(Self::$variant => &$data),+
                }
            }
        }
    };
}

laws! {
    linear LINEAR: Linear "linear",
    log_linear LOG_LINEAR: LogLinear "log-linear",
    porosity_dependent POROSITY_DEPENDENT: PorosityDependent "porosity-dependent",
    engineering ENGINEERING: Engineering "engineering",
    neo_hookean NEO_HOOKEAN: NeoHookean "neo-hookean",
    preconsolidated PRECONSOLIDATED: Preconsolidated "preconsolidated",
    von_mises VON_MISES: VonMises "von-mises",
}
