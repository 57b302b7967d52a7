//! Random numbers, the same from the same seed on every machine. Needs the feature `random`.

use core::f64::consts::TAU;

use nalgebra::Vector3;
use rand_chacha::ChaCha20Rng;
use rand_chacha::rand_core::{Rng as _, SeedableRng as _};

use super::Real;

/// Random numbers from a seed, in 2⁶⁴ independent streams.
///
/// The bits are the key stream of ChaCha20 with a counter and a nonce of 64 bits: the key is the seed (little-endian,
/// then zeros), the nonce the number of the stream. Each number takes the next 64 bits.
///
/// ```
/// use polhode::num::Random;
/// let mut member = Random::new(2026).stream(3); // of an ensemble: the same whichever members were drawn before
/// assert_eq!(member.uniform(), Random::new(2026).stream(3).uniform());
/// assert_ne!(member.normal(), Random::new(2026).stream(4).normal());
/// ```
///
/// Source: D. J. Bernstein, ChaCha, a variant of Salsa20 (2008); normal deviates: Box and Muller (1958).
#[derive(Clone, Debug)]
pub struct Random {
    bits: ChaCha20Rng,
    /// The second deviate of a pair.
    spare: Option<f64>,
}

impl Random {
    /// Stream 0 of a seed.
    pub fn new(seed: u64) -> Self {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        Random { bits: ChaCha20Rng::from_seed(key), spare: None }
    }

    /// Another stream of the same seed, from its beginning, however many numbers were taken from this one.
    #[must_use]
    pub fn stream(&self, number: u64) -> Self {
        let mut bits = ChaCha20Rng::from_seed(self.bits.get_seed());
        bits.set_stream(number);
        Random { bits, spare: None }
    }

    /// Uniform on (0, 1): an odd multiple of 2⁻⁵³, so neither 0 nor 1.
    pub fn uniform(&mut self) -> f64 {
        ((self.bits.next_u64() >> 12) as f64 + 0.5) / (1_u64 << 52) as f64
    }

    /// Uniform between two numbers. Where few doubles lie between them, rounding may give one of the two.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// Uniform over 0, 1, …, count − 1, with a bias below count/2⁶⁴; 0 if there is nothing below `count`.
    pub fn below(&mut self, count: u64) -> u64 {
        ((u128::from(self.bits.next_u64()) * u128::from(count)) >> 64) as u64
    }

    /// Normal with mean 0 and variance 1.
    pub fn normal(&mut self) -> f64 {
        if let Some(spare) = self.spare.take() {
            return spare;
        }
        let radius = (-2.0 * libm::log(self.uniform())).sqrt();
        let (sin, cos) = Real::sin_cos(TAU * self.uniform());
        self.spare = Some(radius * sin);
        radius * cos
    }

    /// A vector of three normal deviates.
    pub fn normal_vector(&mut self) -> Vector3<f64> {
        let (x, y, z) = (self.normal(), self.normal(), self.normal());
        Vector3::new(x, y, z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key_stream(mut random: Random, words: usize) -> String {
        (0..words)
            .flat_map(|_| random.bits.next_u64().to_le_bytes())
            .map(|byte| format!("{byte:02x}"))
            .collect()
    }

    #[test]
    fn bits_are_those_of_the_published_test_vectors() {
        // RFC 8439, A.1, test vectors 1 and 5 (the nonce ends with a byte 02)
        let zero = "76b8e0ada0f13d90405d6ae55386bd28bdd219b8a08ded1aa836efcc8b770dc7\
                    da41597c5157488d7724e03fb8d84a376a43b8f41518a11cc387b669b2ee6586";
        assert_eq!(key_stream(Random::new(0), 8), zero);
        let nonce = "c2c64d378cd536374ae204b9ef933fcd1a8b2288b3dfa49672ab765b54ee27c7\
                     8a970e0e955c14f3a88e741b97c286f75f8fc299e8148362fa198a39531bed6d";
        assert_eq!(key_stream(Random::new(0).stream(2 << 56), 8), nonce);
        // draft-strombergson-chacha-test-vectors-01, TC2 with 256 bits and 20 rounds (the key begins with a byte 01)
        let key = "c5d30a7ce1ec119378c84f487d775a8542f13ece238a9455e8229e888de85bbd\
                   29eb63d0a17a5b999b52da22be4023eb07620a54f6fa6ad8737b71eb0464dac0";
        assert_eq!(key_stream(Random::new(1), 8), key);
    }

    #[test]
    fn a_stream_begins_at_its_beginning() {
        let mut random = Random::new(5);
        let fresh = key_stream(random.stream(7), 20);
        for taken in 0..70 {
            assert_eq!(key_stream(random.stream(7), 20), fresh, "after {taken} numbers");
            assert_eq!(key_stream(random.stream(7).stream(0), 20), key_stream(Random::new(5), 20));
            random.uniform();
        }
        random.normal(); // one of a pair: the other stays with this stream
        let (mut old, mut new) = (random.stream(7), Random::new(5).stream(7));
        assert_eq!(old.normal(), new.normal());
    }

    #[test]
    fn numbers_are_those_of_the_key_stream() {
        // first 64 bits of test vector 1: 0x903d_f1a0_ade0_b876
        let first = 0x903d_f1a0_ade0_b876_u64;
        let uniform = ((first >> 12) as f64 + 0.5) * libm::ldexp(1.0, -52);
        assert_eq!(Random::new(0).uniform(), uniform);
        assert_eq!(Random::new(0).between(-1.0, 3.0), -1.0 + 4.0 * uniform);
        assert_eq!(Random::new(0).below(10), 5); // 0x903d… is 0.5634 of 2⁶⁴
        assert_eq!([Random::new(0).below(0), Random::new(0).below(1)], [0, 0]);
    }

    #[test]
    fn numbers_are_distributed_as_they_should() {
        // means of 100,000 numbers, each within 5 of its standard deviations
        const COUNT: u32 = 100_000;
        let mut random = Random::new(1);
        let mut mean = |of: &mut dyn FnMut(&mut Random) -> f64| {
            (0..COUNT).map(|_| of(&mut random)).sum::<f64>() / f64::from(COUNT)
        };
        let width = 5.0 / f64::from(COUNT).sqrt();
        let variance: [f64; 4] = [1.0 / 12.0, 1.0, 2.0, 96.0]; // of a uniform number, and of x, x² and x⁴ of a normal one
        let uniform = mean(&mut Random::uniform);
        let powers = [0, 1, 2].map(|power: usize| {
            mean(&mut |random| {
                let x = random.normal();
                [x, x * x, x * x * x * x][power]
            })
        });
        let means = [uniform, powers[0], powers[1], powers[2]];
        for ((mean, truth), variance) in means.into_iter().zip([0.5, 0.0, 1.0, 3.0]).zip(variance) {
            assert!((mean - truth).abs() < width * variance.sqrt(), "{mean} for {truth}");
        }
        let thirds = [0, 1, 2].map(|third| mean(&mut |random| f64::from(random.below(3) == third)));
        assert!(
            thirds.iter().all(|share| (share - 1.0 / 3.0).abs() < width * (2.0 / 9.0_f64).sqrt()),
            "{thirds:?}"
        );
        // the two of a pair, and neighbouring streams, are not correlated
        let pairs = mean(&mut |random| {
            let vector = random.normal_vector();
            vector.x * vector.y
        });
        let streams = [1, 2].map(|number| Random::new(9).stream(number));
        let [mut one, mut other] = streams;
        let product = mean(&mut |_| one.normal() * other.normal());
        assert!(pairs.abs() < width && product.abs() < width, "{pairs} {product}");
    }
}
