//! Scenes by their names: in files a scene is a word.

use crate::scene::{LoadKind, Scene, StartPressure};
use crate::{NAMES, SCENES, TERZAGHI};
use oedometer_exact::reference::ReferenceKind;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::borrow::Cow;

impl Scene {
    /// The scene with a name.
    pub fn named(name: &str) -> Option<&'static Self> {
        SCENES.into_iter().find(|scene| scene.name == name)
    }

    /// The scene in whose words the parameters of a solution are given at the command line: that of Terzaghi where none is
    /// about it, or all that acts is a start taken from it.
    pub fn of_solution(kind: ReferenceKind) -> &'static Self {
        let is_alike = |own: ReferenceKind| match (own, kind) {
            (ReferenceKind::LargeStrain(_), ReferenceKind::LargeStrain(_)) => true,
            (ReferenceKind::Manufactured(own), ReferenceKind::Manufactured(other)) => {
                own.motion == other.motion
            }
            _ => own == kind,
        };
        let has_words = |scene: &Self| {
            !matches!((scene.load, &scene.start_pressure), (LoadKind::None, StartPressure::OfReference))
        };
        let scenes = || SCENES.into_iter().filter(|scene| has_words(scene));
        let own = scenes().find(|scene| is_alike(scene.references[0].kind));
        own.or_else(|| scenes().find(|scene| scene.reference_kinds().contains(&kind))).unwrap_or(&TERZAGHI)
    }
}

impl Serialize for Scene {
    fn serialize<S: Serializer>(&self, out: S) -> Result<S::Ok, S::Error> {
        out.serialize_str(self.name)
    }
}

impl<'de> Deserialize<'de> for &'static Scene {
    fn deserialize<D: Deserializer<'de>>(input: D) -> Result<Self, D::Error> {
        let name = String::deserialize(input)?;
        Scene::named(&name).ok_or_else(|| D::Error::unknown_variant(&name, &NAMES))
    }
}

impl JsonSchema for Scene {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> Cow<'static, str> {
        "Scene".into()
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "string", "enum": NAMES })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{MANUFACTURED_VORTEX, scene::Body};

    #[test]
    fn a_motion_has_the_amplitudes_of_its_kind_and_no_other() {
        for scene in SCENES {
            let has = |keys: &[&str]| {
                keys.iter().all(|key| scene.takes(key) == scene.takes(keys[0])) && scene.takes(keys[0])
            };
            let is_vortex = scene == &MANUFACTURED_VORTEX;
            let expected = (is_vortex, scene.body == Body::Square && !is_vortex);
            assert_eq!((has(&["amplitude"]), has(&["amplitude_x", "amplitude_y"])), expected, "{scene:?}");
        }
    }

    #[test]
    fn a_scene_has_one_name_in_files_and_at_the_command_line() {
        for scene in SCENES {
            let written = serde_json::to_value(scene).expect("a name");
            assert_eq!((written.as_str(), Scene::named(scene.name)), (Some(scene.name), Some(scene)));
            assert_eq!(serde_json::from_value::<&'static Scene>(written).expect("a scene"), scene);
        }
    }

    #[test]
    fn the_references_of_a_scene_are_found_by_their_names() {
        for reference in SCENES.into_iter().flat_map(Scene::reference_kinds) {
            let found: Result<ReferenceKind, _> = reference.name().parse();
            assert_eq!(found.map(ReferenceKind::name), Ok(reference.name()));
        }
    }
}
