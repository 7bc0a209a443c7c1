//! zrak-core
