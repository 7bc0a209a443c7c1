//! zrak-cuda
