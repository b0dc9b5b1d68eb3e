//! Assets: what scenes take from files, decoded once however often a scene is loaded.

use std::collections::HashMap;
use std::hash::{BuildHasher, RandomState};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use zeroset_field::sampled::Sampled;
use zeroset_scene::material::Image;
use zeroset_volume::volume::Volume;

/// Decoded files by their content, as long as a scene holds them: an image that is the same after an edit of the scene is not
/// decoded again. Clones share what they hold.
#[derive(Clone, Debug, Default)]
pub struct Assets(Arc<Mutex<Store>>, Option<Arc<dyn Shelf>>);

/// Where what took long to make is kept from one run to the next. What is given is checked before it is believed, and a shelf
/// that cannot keep something just does not.
pub trait Shelf: Send + Sync + std::fmt::Debug {
    /// What was kept under a name: letters and digits.
    fn get(&self, name: &str) -> Option<Vec<u8>>;
    /// Keeps something under a name.
    fn put(&self, name: &str, bytes: &[u8]);
}

/// What was sampled.
pub(crate) struct Baked;

impl Baked {
    /// The name of what is made of these bytes in this way: equal for equal content only (BLAKE3).
    pub(crate) fn key(how: &[&str], bytes: &[u8]) -> String {
        // the number changes when the samples of a mesh do
        let mut hash = blake3::Hasher::new_derive_key("zeroset baked samples 1");
        for word in how {
            hash.update(&(word.len() as u64).to_le_bytes());
            hash.update(word.as_bytes());
        }
        hash.update(bytes);
        hash.finalize().to_hex().to_string()
    }
}

#[derive(Debug, Default)]
struct Store {
    /// Two independent keyed hashes (SipHash) of a content, so that nobody can make two contents that are taken for one.
    keys: [RandomState; 2],
    images: HashMap<Content, Weak<Image>>,
}

/// What a file holds, and the name that messages call it by.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct Content {
    name: String,
    length: usize,
    hashes: [u64; 2],
}

impl Assets {
    /// Assets that also keep what took long on a shelf.
    #[must_use]
    pub fn on(shelf: Arc<dyn Shelf>) -> Assets {
        Assets(Arc::default(), Some(shelf))
    }

    /// What was sampled before, in this run or another.
    pub(crate) fn baked(&self, key: &str, most: u64) -> Option<Sampled> {
        Baked::unpack(&self.1.as_ref()?.get(key)?, most)
    }

    /// Keeps what was sampled.
    pub(crate) fn keep_baked(&self, key: &str, volume: &Volume) {
        if let Some(shelf) = &self.1 {
            shelf.put(key, &Baked::pack(volume));
        }
    }

    fn store(&self) -> MutexGuard<'_, Store> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The image of these bytes, decoded if no scene holds it.
    pub(crate) fn image<E>(
        &self,
        name: &str,
        bytes: &[u8],
        decode: impl FnOnce() -> Result<Image, E>,
    ) -> Result<Arc<Image>, E> {
        let content = {
            let store = self.store();
            let hashes = store.keys.each_ref().map(|key| key.hash_one(bytes));
            Content {
                name: name.to_owned(),
                length: bytes.len(),
                hashes,
            }
        };
        if let Some(image) = self.store().images.get(&content).and_then(Weak::upgrade) {
            return Ok(image);
        }
        let image = Arc::new(decode()?);
        let mut store = self.store();
        store.images.retain(|_, image| image.strong_count() > 0);
        store.images.insert(content, Arc::downgrade(&image));
        Ok(image)
    }
}
