//! Tables of what other crates call, so that it is compiled in this one.
//!
//! The crate that calls generic code compiles it, as that crate is built: in many units and hardly optimised, a step takes five
//! times as long. So each entry point calls a table of functions, one static for lines and one for planes, compiled here.

use std::any::Any;

/// The table for lines or the one for planes, by the number of dimensions in its type.
///
/// # Panics
/// If the type is that of neither table.
pub(crate) fn of_dimension<T: Any>(line: &'static dyn Any, plane: &'static dyn Any) -> &'static T {
    line.downcast_ref().or_else(|| plane.downcast_ref()).expect("one or two dimensions")
}
