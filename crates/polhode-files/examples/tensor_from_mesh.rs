//! Mass, centre of mass and inertia tensor of a closed triangle mesh:
//! cargo run --release --example tensor_from_mesh -- part.stl

use std::io::BufReader;

use polhode::inertia::Amount;
use polhode_files::{inputs, mesh};

/// A cube of one metre as an OBJ file; a path on the command line takes its place.
const CUBE: &str = "
    v 0 0 0\n v 1 0 0\n v 1 1 0\n v 0 1 0\n v 0 0 1\n v 1 0 1\n v 1 1 1\n v 0 1 1
    f 1 4 3 2\n f 5 6 7 8\n f 1 2 6 5\n f 2 3 7 6\n f 3 4 8 7\n f 4 1 5 8
";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let surface = match std::env::args().nth(1) {
        Some(path) if path.ends_with(".stl") => mesh::stl(inputs::open(path.as_ref())?)?,
        Some(path) => mesh::obj(BufReader::new(inputs::open(path.as_ref())?))?,
        None => mesh::obj(CUBE.as_bytes())?,
    };
    let body = surface.mesh()?.with(Amount::Density(2700.0))?; // lengths in m, kg/m³
    println!("mass {} kg, centre of mass {:?} m", body.mass(), body.center_of_mass().as_slice());
    println!("tensor about it, kg m²: {}", body.tensor());
    println!("principal moments {:?}", body.principal_moments());
    Ok(())
}

#[test]
fn the_cube_has_a_sixth_of_its_mass_times_the_square_of_its_edge() -> Result<(), Box<dyn std::error::Error>> {
    let body = mesh::obj(CUBE.as_bytes())?.mesh()?.with(Amount::Density(2700.0))?;
    assert!((body.tensor() - polhode::nalgebra::Matrix3::identity() * 450.0).amax() < 1e-12);
    Ok(())
}
