//! The elementary functions used everywhere in this crate, the same to the last bit on every machine.
//!
//! A function of `f64` such as `sin` comes from the machine's library: those of glibc and musl round differently in the
//! last digit, and even one library differs from processor to processor. The functions here are those of the crate
//! `libm`, in pure Rust. Only +, −, ×, ÷, √, the fused product, and `powi`, which is a loop of products, are the same
//! everywhere by themselves.
//!
//! `pow` is by far the slowest of them: use √ or `cbrt` and products if the exponent is known.

macro_rules! of_the_crate {
    ($($name:ident($($x:ident),+) = $theirs:ident;)+) => {
        $(
            #[doc = concat!("`", stringify!($name), "` as it is for `f64`; angles in radians.")]
            #[inline]
            pub fn $name($($x: f64),+) -> f64 {
                libm::$theirs($($x),+)
            }
        )+
    };
}

of_the_crate! {
    sin(x) = sin;
    cos(x) = cos;
    tan(x) = tan;
    asin(x) = asin;
    acos(x) = acos;
    atan(x) = atan;
    atan2(y, x) = atan2;
    sinh(x) = sinh;
    cosh(x) = cosh;
    tanh(x) = tanh;
    asinh(x) = asinh;
    acosh(x) = acosh;
    atanh(x) = atanh;
    exp(x) = exp;
    exp2(x) = exp2;
    exp_m1(x) = expm1;
    ln(x) = log;
    ln_1p(x) = log1p;
    log2(x) = log2;
    log10(x) = log10;
    pow(x, exponent) = pow;
    cbrt(x) = cbrt;
    hypot(x, y) = hypot;
}

/// sin x and cos x.
#[inline]
pub fn sin_cos(x: f64) -> (f64, f64) {
    libm::sincos(x)
}
