//! zrak-render
