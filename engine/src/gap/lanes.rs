//! Functions of many radii, four at a time.

use wide::f64x4;

/// Calls `function` on `nodes`, four at a time, and writes its K results into the K slices, each as long as `nodes`.
pub fn map_lanes<const K: usize>(
    nodes: &[f64],
    mut into: [&mut [f64]; K],
    function: impl Fn(f64x4) -> [f64x4; K],
) {
    let (whole, rest) = nodes.as_chunks::<4>();
    for (i, four) in whole.iter().enumerate() {
        for (slice, result) in into.iter_mut().zip(function(f64x4::new(*four))) {
            slice[4 * i..4 * i + 4].copy_from_slice(&result.to_array());
        }
    }
    if !rest.is_empty() {
        let mut four = [0.0; 4];
        four[..rest.len()].copy_from_slice(rest);
        for (slice, result) in into.iter_mut().zip(function(f64x4::new(four))) {
            slice[4 * whole.len()..].copy_from_slice(&result.to_array()[..rest.len()]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_of_nodes_is_mapped_one_by_one() {
        for n in 0..10 {
            let nodes: Vec<f64> = (0..n).map(f64::from).collect();
            let (mut twice, mut square) = (vec![f64::NAN; nodes.len()], vec![f64::NAN; nodes.len()]);
            map_lanes(&nodes, [&mut twice, &mut square], |x| [x + x, x * x]);
            let expected: Vec<f64> = nodes.iter().map(|x| x + x).collect();
            assert_eq!(twice, expected);
            let expected: Vec<f64> = nodes.iter().map(|x| x * x).collect();
            assert_eq!(square, expected);
        }
    }
}
