//! What many cases have in common: kept once, read as if each had its own.
//!
//! A study of a million cases has few columns, few lists of outputs, and seldom as many soils as cases.

use oedometer_exact::parameters::MotionParameters;
use oedometer_mpm::scene::arrangement::Arrangement;
use oedometer_mpm::scene::column::Column;
use oedometer_soil::material::Material;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::collections::HashMap;
use std::fmt;
use std::ops::{Deref, DerefMut};
use std::sync::Arc;

/// Values that a pool remembers: of more kinds than these few cases can be alike.
const MOST_KNOWN: usize = 1 << 18;

/// A value that copies share until one of them is changed, which has its own from then on.
#[derive(Clone, Default, PartialEq)]
pub struct Shared<T>(Arc<T>);

impl<T> Shared<T> {
    /// Whether two are one value in memory.
    pub fn is_one_with(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
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

/// A value by whose numbers an equal one is found.
pub trait Numbered: PartialEq + Clone {
    /// Numbers that are the same for equal values; what they leave out, as a new key, makes a pool find less and nothing
    /// wrong.
    fn numbers(&self) -> impl Iterator<Item = u64>;
}

impl Numbered for Vec<f64> {
    fn numbers(&self) -> impl Iterator<Item = u64> {
        self.iter().map(|number| number.to_bits())
    }
}

impl Numbered for Material {
    fn numbers(&self) -> impl Iterator<Item = u64> {
        let Self {
            law,
            youngs_modulus,
            poissons_ratio,
            porosity,
            grain_density,
            water_density,
            water_bulk_modulus,
            hydraulic_conductivity,
            gravity,
            continuity,
            conductivity_mean,
            ..
        } = *self;
        let words = [law as u64, continuity as u64, conductivity_mean as u64];
        let soil = [youngs_modulus, poissons_ratio, porosity, grain_density];
        let water = [water_density, water_bulk_modulus, hydraulic_conductivity, gravity];
        words.into_iter().chain(soil.into_iter().chain(water).map(f64::to_bits))
    }
}

impl Numbered for Column {
    fn numbers(&self) -> impl Iterator<Item = u64> {
        let Self {
            height,
            horizontal_extent,
            load,
            dimensions,
            base,
            loading_time,
            self_weight,
            points: Arrangement { offset, jitter, filling, layers, water_per_cell, .. },
            motion: MotionParameters { amplitude_x, amplitude_y, amplitude, frequency, .. },
            ..
        } = *self;
        let base = base.map_or(0, |base| 1 + base as u64);
        let counts = [dimensions as u64, base, u64::from(self_weight), layers as u64, water_per_cell as u64];
        let body = [height, horizontal_extent, load, loading_time, offset, jitter, filling];
        let motion = [amplitude_x, amplitude_y, amplitude, frequency];
        counts.into_iter().chain(body.into_iter().chain(motion).map(f64::to_bits))
    }
}

/// The different values of many cases, each kept once.
#[derive(Debug)]
pub struct Pool<T>(HashMap<u64, Shared<T>>);

impl<T> Default for Pool<T> {
    fn default() -> Self {
        Self(HashMap::new())
    }
}

impl<T: Numbered> Pool<T> {
    /// Makes a value one with an equal one that came before.
    pub fn share(&mut self, value: &mut Shared<T>) {
        // Fibonacci hashing: neighbours in the bits of a float go far apart.
        let key = value
            .numbers()
            .fold(0_u64, |key, number| (key.rotate_left(23) ^ number).wrapping_mul(0x9e37_79b9_7f4a_7c15));
        if let Some(known) = self.0.get(&key) {
            if **known == **value {
                *value = known.clone();
            }
        } else if self.0.len() < MOST_KNOWN {
            self.0.insert(key, value.clone());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
    fn a_pool_makes_equal_values_one_and_leaves_others_as_they_are() {
        let mut pool = Pool::default();
        let soil = |porosity| Shared::from(Material { porosity, ..Material::default() });
        let mut soils = [0.3, 0.4, 0.3, 0.5, 0.4].map(soil);
        for one in &mut soils {
            pool.share(one);
        }
        assert_eq!(soils.each_ref().map(|one| one.porosity), [0.3, 0.4, 0.3, 0.5, 0.4]);
        assert!(soils[0].is_one_with(&soils[2]) && soils[1].is_one_with(&soils[4]));
        assert!(!soils[0].is_one_with(&soils[1]) && !soils[3].is_one_with(&soils[1]));
    }

    #[test]
    fn values_whose_numbers_fall_together_stay_apart() {
        #[derive(Clone, PartialEq)]
        struct Alike(u8);
        impl Numbered for Alike {
            fn numbers(&self) -> impl Iterator<Item = u64> {
                [1].into_iter()
            }
        }
        let mut pool = Pool::default();
        let mut two = [Shared::from(Alike(1)), Shared::from(Alike(2))];
        for one in &mut two {
            pool.share(one);
        }
        assert_eq!([two[0].0.0, two[1].0.0], [1, 2]);
    }

    #[test]
    fn what_is_shared_is_written_and_read_as_the_value_itself() {
        let times = Shared::from(vec![0.1, 0.2]);
        let text = serde_json::to_string(&times).expect("plain");
        assert_eq!((text.as_str(), format!("{times:?}")), ("[0.1,0.2]", "[0.1, 0.2]".to_owned()));
        assert_eq!(serde_json::from_str::<Shared<Vec<f64>>>(&text).expect("the same"), times);
    }
}
