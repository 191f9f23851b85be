//! Scenes: the physical problems by name, each in a file of its own, with what a study may say of it and what comes out.
//!
//! A scene makes a [`Problem`](oedometer_problem::problem::Problem), which any solver may solve: nothing here knows one.
//! `column` is the geometry and load of all, `scene` what every scene says, `limit` what cannot be together, `problem` what
//! becomes of it.

// Tests may call the platform's functions: a second opinion there.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

pub mod column;
pub mod limit;
mod manufactured;
mod named;
mod problem;
pub mod scene;

pub use scene::Scene;

/// Files of scenes with what is in them, in the order of tables.
macro_rules! scenes {
    ($($file:ident $scene:ident),+ $(,)?) => {
        $(mod $file;
        pub use $file::$scene;)+

        const COUNT: usize = [$(stringify!($scene)),+].len();
        /// All scenes, in the order of tables.
        pub static SCENES: [&Scene; COUNT] = [$(&$scene),+];
        /// Their names.
        pub static NAMES: [&str; COUNT] = [$($file::$scene.name),+];
    };
}

scenes! {
    terzaghi TERZAGHI,
    single_mode SINGLE_MODE,
    xie_leo XIE_LEO,
    cosine_layer COSINE_LAYER,
    dynamic_column DYNAMIC_COLUMN,
    dynamic_single_mode DYNAMIC_SINGLE_MODE,
    standing_wave STANDING_WAVE,
    mandel MANDEL,
    at_rest AT_REST,
    layered LAYERED,
    yield_front YIELD_FRONT,
    sealed_element SEALED_ELEMENT,
    footing FOOTING,
    manufactured_box MANUFACTURED_BOX,
    manufactured_shear MANUFACTURED_SHEAR,
    manufactured_vortex MANUFACTURED_VORTEX,
}
