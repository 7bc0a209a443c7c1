//! The renderer itself: every function that decides what a sample is.
//!
//! This crate is compiled twice from the same source, for the processor by stable rustc and for
//! NVIDIA GPUs by rustc's `nvptx64` target, and gives the same bits on both. To keep that promise:
//!
//! - Only IEEE-754 operations with one defined result are used: `+ - * /`, [`math::sqrt`],
//!   comparisons, conversions and integer arithmetic. Transcendental functions are the polynomials in
//!   [`math`]; nothing here calls `f32::sin` or `f32::mul_add`.
//! - Nothing here allocates, does IO, keeps state between samples, or can fail.
//! - `unsafe` lives in [`accessor`] alone.
//!
//! Reading order: [`scene`] (the data), [`ray`] and [`interaction`], [`shapes`], [`accel`],
//! [`textures`], [`bxdfs`], [`materials`], [`media`], [`lights`], [`sampler`], [`camera`], [`film`], and
//! [`integrators`], which puts them together.

#![cfg_attr(target_arch = "nvptx64", no_std, feature(core_intrinsics), allow(internal_features))]

pub mod accel;
pub mod accessor;
pub mod bxdfs;
pub mod camera;
pub mod film;
pub mod integrators;
pub mod interaction;
pub mod launch;
pub mod lights;
pub mod materials;
pub mod math;
pub mod media;
pub mod ray;
pub mod sampler;
pub mod scene;
pub mod shapes;
pub mod textures;

#[cfg(test)]
mod testing;
