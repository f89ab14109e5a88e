//! The values that move a path by a closed form, or by its own derivatives.

/// What moves a path at a held contact radius by a closed form, or a pull by its variational equation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mover {
    /// E*.
    Modulus,
    /// γ.
    Adhesion,
    /// k.
    Stiffness,
    /// σ₀ of an adhesion with a range, γ held.
    Strength,
    /// `h_c` of it, γ held.
    Extent,
    /// v₀.
    Speed,
    /// n.
    Exponent,
    /// The contact radius at which a pull begins.
    Start,
    /// 1/σ₀², for an adhesion with a tension σ₀ up to the separation γ/σ₀, at the value 0: not by its logarithm.
    Range,
}
