//! Radau IIA with five stages, order 9: the weights, and the error estimate of order 5.
//!
//! ```text
//! y₁ = y₀ + h Σ b_j p_j,     p_i = φ(ξ₀ + c_i h, y₀ + h Σ A_ij p_j),     b = the last row of A
//! error = (1 − h γ₀ φ_y)⁻¹ h [γ₀ φ(ξ₀, y₀) + Σ d_j p_j],     Σ d_j c_j^{k−1} = −γ₀ [k = 1]
//! ```
//!
//! c are the roots of d⁴/dx⁴ [x⁴ (x − 1)⁵], γ₀ is the real eigenvalue of A. E. Hairer and G. Wanner, Solving Ordinary Differential
//! Equations II, Springer (1996), doi:10.1007/978-3-642-05221-7, sections IV.5 and IV.8.

/// The number of stages.
pub const STAGES: usize = 5;

/// c.
pub const NODES: [f64; STAGES] = [
    0.057_104_196_114_517_68,
    0.276_843_013_638_123_8,
    0.583_590_432_368_916_8,
    0.860_240_135_656_219_5,
    1.0,
];

/// A.
pub const WEIGHTS: [[f64; STAGES]; STAGES] = [
    [
        0.072_998_864_317_903_33,
        -0.026_735_331_107_945_57,
        0.018_676_929_763_984_353,
        -0.012_879_106_093_306_44,
        0.005_042_839_233_882_015,
    ],
    [
        0.153_775_231_479_182_46,
        0.146_214_867_847_493_52,
        -0.036_444_568_905_128_09,
        0.021_233_063_119_304_72,
        -0.007_935_579_902_728_777,
    ],
    [
        0.140_063_045_684_809_87,
        0.298_967_129_491_283_46,
        0.167_585_070_135_248_95,
        -0.033_969_101_686_617_74,
        0.010_944_288_744_192_253,
    ],
    [
        0.144_894_308_109_534_77,
        0.276_500_068_760_159_2,
        0.325_797_922_910_421_03,
        0.128_756_753_254_909_76,
        -0.015_708_917_378_805_327,
    ],
    [
        0.143_713_560_791_225_94,
        0.281_356_015_149_462_07,
        0.311_826_522_975_741_26,
        0.223_103_901_083_570_75,
        0.04,
    ],
];

/// γ₀.
pub const REAL_EIGENVALUE: f64 = 0.159_065_844_427_469_13;

/// d.
pub const ERROR_WEIGHTS: [f64; STAGES] = [
    -0.252_343_312_249_546_4,
    0.160_357_122_102_969_96,
    -0.116_273_134_340_962_81,
    0.081_006_648_945_564_02,
    -0.031_813_168_885_493_83,
];

/// Σ weight · value.
pub fn dot(weights: &[f64; STAGES], values: &[f64; STAGES]) -> f64 {
    weights.iter().zip(values).map(|(weight, value)| weight * value).sum()
}

/// The weights of a polynomial through the stages: 1 over the product of all `c_i − c_j`.
const SHARES: [f64; STAGES] = {
    let mut shares = [1.0; STAGES];
    let mut i = 0;
    while i < STAGES {
        let mut j = 0;
        while j < STAGES {
            if j != i {
                shares[i] /= NODES[i] - NODES[j];
            }
            j += 1;
        }
        i += 1;
    }
    shares
};

/// The polynomial through the values at the stages, at θ in steps from the beginning; beyond 1 it extrapolates.
pub fn interpolated(values: &[f64; STAGES], theta: f64) -> f64 {
    let off = NODES.map(|c| theta - c);
    let mut before = [1.0; STAGES];
    for i in 1..STAGES {
        before[i] = before[i - 1] * off[i - 1];
    }
    let (mut sum, mut after) = (0.0, 1.0);
    for i in (0..STAGES).rev() {
        sum += values[i] * SHARES[i] * before[i] * after;
        after *= off[i];
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_weights_integrate_powers() {
        for k in 0_i32..5 {
            let powers = NODES.map(|c| c.powi(k));
            for (c, row) in NODES.iter().zip(&WEIGHTS) {
                assert!((dot(row, &powers) - c.powi(k + 1) / f64::from(k + 1)).abs() < 2e-16, "{k}");
            }
            let rest = if k == 0 { -REAL_EIGENVALUE } else { 0.0 };
            assert!((dot(&ERROR_WEIGHTS, &powers) - rest).abs() < 2e-16, "{k}");
        }
        // Order 9 of the last row, and no more.
        let last = |k: i32| dot(&WEIGHTS[4], &NODES.map(|c| c.powi(k))) - 1.0 / f64::from(k + 1);
        assert!((5..9).all(|k| last(k).abs() < 2e-16) && last(9).abs() > 1e-7);
        let of = |x: f64| 1.0 - 2.0 * x + 3.0 * x.powi(4);
        assert!((interpolated(&NODES.map(of), 1.7) - of(1.7)).abs() < 1e-13);
    }
}
