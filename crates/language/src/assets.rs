//! Assets: what scenes take from files, decoded once however often a scene is loaded.

use std::collections::HashMap;
use std::hash::{BuildHasher, RandomState};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use zeroset_scene::material::Image;

/// Decoded files by their content, as long as a scene holds them: an image that is the same after an edit of the scene is not
/// decoded again. Clones share what they hold.
#[derive(Clone, Debug, Default)]
pub struct Assets(Arc<Mutex<Store>>);

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
