//! zrak-accel
