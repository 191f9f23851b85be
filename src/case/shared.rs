//! Inputs that neighbouring cases share: stored once, read as if each case had its own.

use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;
use std::ops::{Deref, DerefMut};
use std::sync::Arc;

/// A value that copies share until one of them is changed, which has its own from then on.
#[derive(Clone, Default, PartialEq)]
pub struct Shared<T>(Arc<T>);

impl<T> Shared<T> {
    /// Whether two are one value in memory.
    pub fn is_one_with(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }

    /// Makes it one with an equal value.
    pub fn share_with(&mut self, other: &Self)
    where
        T: PartialEq,
    {
        if self.0 == other.0 {
            self.0 = Arc::clone(&other.0);
        }
    }
}

impl<T> From<T> for Shared<T> {
    fn from(value: T) -> Self {
        Self(Arc::new(value))
    }
}

impl<T> Deref for Shared<T> {
    type Target = T;
    fn deref(&self) -> &T {
        &self.0
    }
}

impl<T: Clone> DerefMut for Shared<T> {
    fn deref_mut(&mut self) -> &mut T {
        Arc::make_mut(&mut self.0)
    }
}

impl<T: fmt::Debug> fmt::Debug for Shared<T> {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(out)
    }
}

impl<T: Serialize> Serialize for Shared<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        T::serialize(self, serializer)
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Shared<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        T::deserialize(deserializer).map(Self::from)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use oedometer_soil::material::Material;

    #[test]
    fn a_copy_that_is_changed_has_its_own_and_the_others_keep_theirs() {
        let first = Shared::from(Material::default());
        let mut other = first.clone();
        assert!(other.is_one_with(&first));
        other.porosity = 0.4;
        assert_eq!((first.porosity, other.porosity), (Material::default().porosity, 0.4));
        assert!(!other.is_one_with(&first) && other != first);
    }

    #[test]
    fn an_equal_value_becomes_one_with_another_and_a_different_one_stays() {
        let first = Shared::from(Material::default());
        let [mut equal, mut other] = [0.3, 0.4].map(|porosity| Shared::from(Material { porosity, ..*first }));
        equal.share_with(&first);
        other.share_with(&first);
        assert!(equal.is_one_with(&first) && !other.is_one_with(&first));
        assert_eq!(other.porosity, 0.4);
    }

    #[test]
    fn what_is_shared_is_written_and_read_as_the_value_itself() {
        let times = Shared::from(vec![0.1, 0.2]);
        let text = serde_json::to_string(&times).expect("plain");
        assert_eq!((text.as_str(), format!("{times:?}")), ("[0.1,0.2]", "[0.1, 0.2]".to_owned()));
        assert_eq!(serde_json::from_str::<Shared<Vec<f64>>>(&text).expect("the same"), times);
    }
}
