//! Inertia from measured angular velocity.
mod banded;
mod coordinates;
mod error;
mod identifiability;
mod qp;
mod record;
mod quadrature;
mod weak;
pub use record::{RateUnit, Reading, Record, RecordError, Segment, TimeUnit};

#[cfg(test)]
mod proto {
    use super::*;
    use nalgebra::{Matrix3, Vector3, UnitQuaternion, Quaternion};
    use crate::body::Inertia;
    use crate::flow::FreeMotion;
    struct Rng(u64);
    impl Rng {
        fn u(&mut self) -> f64 { self.0 = self.0.wrapping_add(0x9E3779B97F4A7C15); let mut z = self.0; z = (z ^ (z >> 30)).wrapping_mul(0xBF58476D1CE4E5B9); z = (z ^ (z >> 27)).wrapping_mul(0x94D049BB133111EB); z ^= z >> 31; ((z >> 11) as f64 + 0.5) / 9007199254740992.0 }
        fn n(&mut self) -> f64 { let (a, b) = (self.u(), self.u()); (-2.0*libm::log(a)).sqrt() * libm::cos(6.283185307179586*b) }
    }
    #[test]
    fn monte() {
        let trials: usize = std::env::var("TRIALS").map_or(20, |s| s.parse().unwrap());
        let rad: Option<f64> = std::env::var("RADIUS").ok().map(|s| s.parse().unwrap());
        for sigma in [1e-3, 1e-2, 1e-1] {
            let mut rng = Rng(5);
            let (mut nees, mut own, mut rat, mut cov) = (0.0, 0.0, 0.0, 0);
            let mut radii = vec![];
            let mut chi = 0.0;
            let t0 = std::time::Instant::now();
            let mut tfit = 0.0;
            for _ in 0..trials {
                let q = UnitQuaternion::from_quaternion(Quaternion::new(rng.n(), rng.n(), rng.n(), rng.n()));
                let r = q.to_rotation_matrix();
                let j = r.matrix() * Matrix3::from_diagonal(&Vector3::new(1.0, 2.0, 2.6)) * r.matrix().transpose() / 5.6;
                let w0 = Vector3::new(rng.n(), rng.n(), rng.n()).normalize();
                let inertia = Inertia::from_tensor(j).unwrap();
                let m = FreeMotion::from_omega(&inertia, UnitQuaternion::identity(), w0).unwrap();
                let ji = j.try_inverse().unwrap();
                let times: Vec<f64> = (0..6001).map(|i| i as f64 * 0.01).collect();
                let rates: Vec<_> = times.iter().map(|&t| ji * Vector3::from(m.at(t).unwrap().momentum_body) + Vector3::new(rng.n(), rng.n(), rng.n())*sigma).collect();
                let rms = (rates.iter().map(|w| w.norm_squared()).sum::<f64>() / 6001.0).sqrt();
                let s = [weak::Stretch::new(times.iter().map(|t| t*rms).collect(), rates.iter().map(|w| w/rms).collect())];
                let v = sigma*sigma/rms/rms;
                let t1 = std::time::Instant::now();
                let e = weak::estimate(&s, rad, v).unwrap();
                tfit += t1.elapsed().as_secs_f64();
                radii.push(e.radius);
                let xt = coordinates::coordinates(&j);
                let d = e.x - xt;
                let h = e.stacked.information() / v;
                let c = weak::covariance(&e.stacked.information(), &e.inflation, v);
                let truth = {
                    // CRLB by finite differences
                    let times2: Vec<f64> = times.iter().step_by(10).copied().collect();
                    let run = |x: &coordinates::Coordinates, w: Vector3<f64>| -> Vec<Vector3<f64>> {
                        let j = coordinates::tensor(x); let ji = j.try_inverse().unwrap();
                        let m = FreeMotion::from_omega(&Inertia::from_tensor(j).unwrap(), UnitQuaternion::identity(), w).unwrap();
                        times2.iter().map(|&t| ji * Vector3::from(m.at(t).unwrap().momentum_body)).collect()
                    };
                    let mut cols = vec![];
                    for k in 0..8 {
                        let mut a = (xt, w0); let mut b = (xt, w0); let h = 1e-6;
                        if k < 5 { a.0[k] += h; b.0[k] -= h } else { a.1[k-5] += h; b.1[k-5] -= h }
                        let (p, q) = (run(&a.0, a.1), run(&b.0, b.1));
                        cols.push(p.iter().zip(&q).map(|(p, q)| (p-q)/(2.0*h)).collect::<Vec<_>>());
                    }
                    let f = nalgebra::SMatrix::<f64,8,8>::from_fn(|a, b| cols[a].iter().zip(&cols[b]).map(|(p, q)| p.dot(q)).sum::<f64>() * 10.0 / sigma / sigma);
                    let c = f.try_inverse().unwrap();
                    coordinates::Form::from_fn(|a, b| c[(a, b)])
                };
                let one = d.dot(&(truth.try_inverse().unwrap()*d));
                if std::env::var("SHOW").is_ok() { println!("  r {:.2} nees {one:.2} own {:.2} hv {:?}", e.radius, d.dot(&(h*d)), c.map(|c| d.dot(&(c.try_inverse().unwrap()*d)))); }
                nees += one;
                if let Some(c) = c { let s = d.dot(&(c.try_inverse().unwrap()*d)); own += s; if s < 11.0705 { cov += 1 } rat += (c.trace()/truth.trace()).sqrt(); }
                chi += e.stacked.misfit / v / (e.stacked.rows as f64 - 5.0);
            }
            radii.sort_by(f64::total_cmp);
            let n = trials as f64;
            println!("sigma {sigma}: N5 crlb {:.3} own {:.3} cover {:.3} ratio {:.3} chi {:.3} radius {:.2} {:.2} {:.2} time {:.1}s fit {:.1} ms", (nees/5.0/n).sqrt(), (own/5.0/n).sqrt(), cov as f64/n, rat/n, chi/n, radii[0], radii[trials/2], radii[trials-1], t0.elapsed().as_secs_f64(), tfit/n*1e3);
        }
    }
}
