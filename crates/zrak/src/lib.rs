//! zrak
