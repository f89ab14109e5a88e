//! The elementary functions of everything here, the same to the last bit on every machine.
//!
//! A function of `f64` such as `sin` is the library's of the machine: glibc's and musl's round differently in the last
//! digit, and one library differs from processor to processor. These are the crate `libm`'s, in Rust alone. Only +, −, ×, ÷,
//! √ and the fused product are the same everywhere by themselves, and `powi`, which is a loop of products.
//!
//! `pow` is the slowest of them by far: take √ or `cbrt` and products where the exponent is known.

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
