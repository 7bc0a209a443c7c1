//! zrak-cpu
