//! zrak-image
