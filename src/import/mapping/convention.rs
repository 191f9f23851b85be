//! What a file means for which nothing is declared.

use crate::import::mapping::Mapping;
use crate::study::diagnostic::StudyError;
use crate::study::file::StudySource;

/// What a file means for which nothing is declared, as a mapping file would say it.
pub const CONVENTION: &str = r#"sample = "points"

[columns]
t = "t"
y = "y"
p = "p"
u_y = "u_y"

[units]
time = "s"
length = "m"
displacement = "m"
stress = "Pa"

[sign]
y = "up"
p = "compression-positive"
u_y = "up"

[position]
y = "reference"
"#;

/// The same of a layer: places have two coordinates, and displacements two components.
pub const PLANE_CONVENTION: &str = r#"sample = "points"

[columns]
t = "t"
x = "x"
y = "y"
p = "p"
u_x = "u_x"
u_y = "u_y"

[units]
time = "s"
length = "m"
displacement = "m"
stress = "Pa"

[sign]
x = "right"
y = "up"
p = "compression-positive"
u_x = "right"
u_y = "up"

[position]
y = "reference"

[origin]
x = 0.0
y = 0.0
"#;

impl Mapping {
    /// The meaning of a file for which nothing is declared, of a column or of a layer.
    ///
    /// # Errors
    /// Never: the text is a constant.
    pub fn convention(is_plane: bool) -> Result<Self, StudyError> {
        let text = if is_plane { PLANE_CONVENTION } else { CONVENTION }.to_owned();
        let mapping = Self::read(&StudySource { name: "the convention".to_owned(), text })?;
        Ok(Self { is_convention: true, ..mapping })
    }
}
