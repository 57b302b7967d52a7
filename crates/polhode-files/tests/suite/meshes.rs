//! Meshes from STL, OBJ and PLY files, and what is refused.

use std::fmt::Write;
use std::io::{BufRead, Read};

use nalgebra::Vector3;
use polhode::inertia::{Amount, MassProperties, Mesh};
use polhode_files::mesh::{self, MeshFileError};
use proptest::prelude::*;

type Triangle = [Vector3<f64>; 3];

fn largest_error(found: &MassProperties, expected: &MassProperties) -> f64 {
    let mass = (found.mass() / expected.mass() - 1.0).abs();
    let scale = expected.tensor().amax();
    let radius = (scale / expected.mass()).sqrt();
    let center = (found.center_of_mass() - expected.center_of_mass()).amax() / radius;
    mass.max(center).max((found.tensor() - expected.tensor()).amax() / scale)
}

fn from_stl(bytes: impl Read) -> Result<Mesh, MeshFileError> {
    Ok(mesh::stl(bytes)?.mesh()?)
}

fn from_obj(bytes: impl BufRead) -> Result<Mesh, MeshFileError> {
    Ok(mesh::obj(bytes)?.mesh()?)
}

fn from_ply(bytes: impl BufRead) -> Result<Mesh, MeshFileError> {
    Ok(mesh::ply(bytes)?.mesh()?)
}

/// The surface of the box [0, 1]³, each face cut into 2 n² triangles, corners counterclockwise from outside.
fn cube(n: usize) -> Vec<Triangle> {
    let mut triangles = Vec::new();
    for axis in 0..3 {
        for side in [0.0, 1.0] {
            let at = |i: usize, j: usize| {
                let mut v = Vector3::zeros();
                v[axis] = side;
                v[(axis + 1) % 3] = i as f64 / n as f64;
                v[(axis + 2) % 3] = j as f64 / n as f64;
                v
            };
            for i in 0..n {
                for j in 0..n {
                    let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
                    for [p, q, r] in [[a, b, c], [a, c, d]] {
                        triangles.push(if side == 1.0 { [p, q, r] } else { [p, r, q] });
                    }
                }
            }
        }
    }
    triangles
}

fn stl(triangles: &[Triangle]) -> Vec<u8> {
    let mut bytes = b"binary".to_vec();
    bytes.resize(80, 0);
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for triangle in triangles {
        bytes.extend([0; 12]);
        for x in triangle.iter().flat_map(|v| v.iter()) {
            bytes.extend((*x as f32).to_le_bytes());
        }
        bytes.extend([0; 2]);
    }
    bytes
}

fn ascii(triangles: &[Triangle]) -> String {
    let mut text = String::from("solid a cube\n");
    for triangle in triangles {
        text += " facet normal 0 0 0\n  outer loop\n";
        for v in triangle {
            writeln!(text, "   vertex {:e} {:e} {:e}", v.x, v.y, v.z).unwrap();
        }
        text += "  endloop\n endfacet\n";
    }
    text + "endsolid a cube\n"
}

/// Quadrilaterals and triangles, textures and normals, backward indices, all of which OBJ files have.
const OBJ_CUBE: &str = "\
# a cube
mtllib cube.mtl
v 0 0 0
v 1 0 0 1.0
v 1 1 0
v 0 1 0
v 0 0 1
v 1 0 1
v 1 1 1
v 0 1 1
vn 0 0 1
usemtl steel
f 4 3 2 1
f 5/1/1 6/2/1 7/3/1 8/4/1
f 1//1 2//1 6//1 5//1
f -7 -6 -2 -3
f 3 4 8
f 3 8 7
f 4 1 5 8
";

#[test]
fn every_format_reads_the_same_cube() {
    let triangles = cube(3);
    let exact = Mesh::new(cube(1)).unwrap().with(Amount::Mass(6.0)).unwrap();
    let text = ascii(&triangles);
    let mut named_solid = stl(&triangles);
    named_solid[..80].fill(b' ');
    named_solid[..9].copy_from_slice(b"solid foo");
    let read = [
        from_stl(text.as_bytes()).unwrap(),
        from_stl(text.to_uppercase().replace('\n', "\r\n").as_bytes()).unwrap(),
        from_obj(OBJ_CUBE.as_bytes()).unwrap(),
        from_obj(OBJ_CUBE.replacen("# a cube\nmtllib cube.mtl\n", "\u{feff}", 1).as_bytes()).unwrap(),
    ];
    for mesh in read {
        let body = mesh.with(Amount::Mass(6.0)).unwrap();
        assert!(largest_error(&body, &exact) < 2e-16 * 4.0, "{body:?}");
    }
    for bytes in [stl(&cube(1)), stl(&cube(4)), {
        let mut b = named_solid;
        b[6..9].copy_from_slice(b"abc");
        b
    }] {
        let mesh = from_stl(bytes.as_slice()).unwrap();
        // a third is no f32: its vertices are off by 1e-8 along the faces, which no face feels
        assert!((mesh.volume() - 1.0).abs() < 1e-15);
    }
    let mesh = Mesh::new(triangles).unwrap();
    assert_eq!((mesh.triangles(), mesh.vertices()), (108, 56));
}

#[test]
fn a_triangle_of_an_obj_belongs_to_its_object_and_to_all_its_groups() {
    // triangles of the areas 1, 2, 4 and 8, whose sum tells which they are
    let text = "v 0 0 0\nv 2 0 0\nv 0 1 0\nv 0 2 0\nv 0 4 0\nv 0 8 0\n\
                o left arm\ng upper skin\nf 1 2 3\ng lower\nf 1 2 4\no body\nf 1 2 5\ng skin\nf 1 2 6\n";
    let surface = mesh::obj(text.as_bytes()).unwrap();
    assert_eq!(surface.groups().collect::<Vec<_>>(), ["left arm", "upper", "skin", "lower", "body"]);
    let area = |name: &str| {
        let group = surface.group(name)?;
        Some(group.triangles().map(|[a, b, c]| (b - a).cross(&(c - a)).norm() / 2.0).sum::<f64>())
    };
    let areas = ["left arm", "upper", "skin", "lower", "body", "left"].map(area);
    assert_eq!(areas, [Some(3.0), Some(1.0), Some(9.0), Some(6.0), Some(12.0), None]);
}

/// The name of a solid is all that follows the word; solids of one name are one group.
#[test]
fn solids_of_an_ascii_stl_have_their_whole_names() {
    let facet = |size: u32| {
        format!(
            "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex {size} 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
        )
    };
    let solid = |name: &str, size| format!("solid {name}\n{}endsolid {name}\n", facet(size));
    let text = [("left arm", 2), ("left  leg ", 4), ("left", 8), ("left arm", 16)];
    let text: String = text.into_iter().map(|(name, size)| solid(name, size)).collect();
    let surface = mesh::stl(text.as_bytes()).unwrap();
    assert_eq!(surface.groups().collect::<Vec<_>>(), ["left arm", "left leg", "left"]);
    let area = |name: &str| {
        let group = surface.group(name)?;
        Some(group.triangles().map(|[a, b, c]| (b - a).cross(&(c - a)).norm() / 2.0).sum::<f64>())
    };
    assert_eq!(["left arm", "left leg", "left", "arm"].map(area), [Some(9.0), Some(2.0), Some(4.0), None]);
}

#[test]
fn a_line_without_end_is_refused() {
    let long = "line 2 is longer than 1048576 bytes; is this the right file?";
    let endless = |head: &'static [u8]| std::io::BufReader::new(head.chain(std::io::repeat(b'1')));
    assert_eq!(from_obj(endless(b"# cube\nv 0 0 ")).unwrap_err().to_string(), long);
    assert_eq!(from_stl(endless(b"solid s\nvertex 0 0 ")).unwrap_err().to_string(), long);
}

#[test]
fn broken_files_name_the_byte_or_the_line() {
    let bytes = stl(&cube(1));
    let message = |bytes: &[u8]| from_stl(bytes).unwrap_err().to_string();
    assert_eq!(
        message(&bytes[..400]),
        "STL is truncated: its header announces 12 triangles, 684 bytes, but it ends at byte 400, in triangle 7"
    );
    assert_eq!(
        message(&bytes[..684 - 50]),
        "STL is truncated: its header announces 12 triangles, 684 bytes, but it ends at byte 634, in triangle 12"
    );
    assert_eq!(
        message(&bytes[..60]),
        "STL ends at byte 60, within its header of 84 bytes, and does not begin with 'solid'"
    );
    assert_eq!(
        message(&[bytes.as_slice(), &[0]].concat()),
        "STL announces 12 triangles, which end at byte 684, but more bytes follow; its count is wrong"
    );
    let mut lying = bytes.clone();
    lying[80..84].copy_from_slice(&[0xff; 4]); // four thousand million triangles take no memory
    assert!(
        message(&lying)
            .contains("announces 4294967295 triangles, 214748364834 bytes, but it ends at byte 684")
    );

    let text = ascii(&cube(1));
    let cut = text.find("endsolid").unwrap();
    assert_eq!(
        message(&text.as_bytes()[..cut]),
        format!("STL is truncated: it ends at byte {cut}, line 85, in triangle 13, without 'endsolid'")
    );
    let message = |text: String| message(text.as_bytes());
    assert_eq!(
        message(text.replacen("vertex 0e0 0e0 1e0", "vertex 0e0 0e0", 1)),
        "line 12: 'vertex 0e0 0e0' where 'vertex x y z' with three numbers is expected"
    );
    assert_eq!(
        message(text.replacen("   vertex 0e0 0e0 1e0\n", "", 1)),
        "line 14: 'endfacet' where the third vertex of a facet, and no fourth, is expected"
    );
    let end = text.rfind(" endfacet\n").unwrap();
    assert_eq!(
        message(text[..end].to_owned() + &text[end + " endfacet\n".len()..]),
        "line 85: 'endsolid a cube' where 'endfacet' is expected"
    );
    assert_eq!(
        message(format!("{text}facet normal 0 0 0\n")),
        "line 87: 'facet normal 0 0 0' where 'solid' or the end of the file is expected"
    );
    assert!(mesh::stl(format!("{text}\n{text}\n").as_bytes()).is_ok());
    assert_eq!(
        message(text.replacen("outer loop", "other loop", 1)),
        "line 3: 'other loop' where a line of an ASCII STL is expected"
    );
    let obj = |text: String| from_obj(text.as_bytes()).unwrap_err().to_string();
    assert_eq!(
        obj(OBJ_CUBE.replace("f 3 8 7", "f 3 8 9")),
        "line 18: face names vertex 9, but only 8 vertices are above it"
    );
    assert_eq!(
        obj(OBJ_CUBE.replace("f 3 8 7", "f 3 0 7")),
        "line 18: face names vertex 0, but only 8 vertices are above it"
    );
    assert_eq!(
        obj(OBJ_CUBE.replace("v 1 1 0", "v 1 1 O")),
        "line 5: 'v 1 1 O' where 'v x y z' with three numbers is expected"
    );
    assert_eq!(
        obj(OBJ_CUBE.replace("f 3 8 7", "f 3 8")),
        "line 18: 'f 3 8' where a face of at least three vertices is expected"
    );
    assert!(
        obj(OBJ_CUBE.replace("f 3 8 7\n", ""))
            .starts_with("the mesh is open; edges with one triangle only: 3")
    );
}

#[test]
fn a_file_cut_anywhere_is_refused() {
    let bytes = stl(&cube(1));
    for length in 0..bytes.len() {
        let message = from_stl(&bytes[..length]).unwrap_err().to_string();
        assert!(message.contains(&format!("ends at byte {length}")), "{message}");
    }
    let text = ascii(&cube(1));
    let end = text.find("endsolid").unwrap() + "endsolid".len();
    for length in 0..end {
        assert!(from_stl(&text.as_bytes()[..length]).is_err(), "{length}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn bytes_of_no_format_are_refused(noise in prop::collection::vec(any::<u8>(), 0..2000)) {
        prop_assert!(from_stl(noise.as_slice()).is_err());
        prop_assert!(from_obj(noise.as_slice()).is_err());
    }
}

/// A tetrahedron with three edges along the axes, in one of the encodings of PLY.
fn ply(encoding: &str) -> Vec<u8> {
    let header = format!(
        "ply\nformat {encoding} 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\nproperty uchar red\n\
         property double y\nproperty float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n"
    );
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0_f32]];
    let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3_i32]];
    let mut bytes = header.into_bytes();
    for [x, y, z] in corners {
        match encoding {
            "ascii" => bytes.extend(format!("{x} 255 {y} {z}\n").bytes()),
            "binary_little_endian" => {
                bytes.extend(x.to_le_bytes());
                bytes.push(255);
                bytes.extend(f64::from(y).to_le_bytes());
                bytes.extend(z.to_le_bytes());
            }
            _ => {
                bytes.extend(x.to_be_bytes());
                bytes.push(255);
                bytes.extend(f64::from(y).to_be_bytes());
                bytes.extend(z.to_be_bytes());
            }
        }
    }
    for [a, b, c] in faces {
        match encoding {
            "ascii" => bytes.extend(format!("3 {a} {b} {c}\n").bytes()),
            _ => {
                bytes.push(3);
                for index in [a, b, c] {
                    let little = encoding == "binary_little_endian";
                    bytes.extend(if little { index.to_le_bytes() } else { index.to_be_bytes() });
                }
            }
        }
    }
    bytes
}

#[test]
fn ply_files_are_read_in_every_encoding() {
    for encoding in ["ascii", "binary_little_endian", "binary_big_endian"] {
        let mesh = from_ply(&ply(encoding)[..]).unwrap();
        assert_eq!((mesh.volume(), mesh.triangles()), (1.0, 4), "{encoding}");
        let bytes = ply(encoding);
        let message = from_ply(&bytes[..bytes.len() - 3]).unwrap_err().to_string();
        assert_eq!(message, "PLY is truncated: it ends in face 4 of 4", "{encoding}");
        let message = from_ply(&bytes.repeat(2)[..]).unwrap_err().to_string();
        let says = "PLY announces 4 of element face as its last, but more follows";
        assert!(message.starts_with(says), "{encoding}: {message}");
    }
    // blank lines are no more than that
    let mut padded = ply("ascii");
    padded.extend(b"\n \r\n");
    assert!(from_ply(&padded[..]).is_ok());
    let message = |text: &str| from_ply(text.as_bytes()).unwrap_err().to_string();
    let head = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n\
                element face 1\nproperty list uint int vertex_index\nend_header\n0 0 0\n";
    for (text, expected) in [
        ("solid\n", "line 1: 'solid' where 'ply' is expected"),
        (
            "ply\nformat xml 1.0\n",
            "line 2: 'format xml 1.0' where format ascii, binary_little_endian or binary_big_endian is expected",
        ),
        (
            "ply\nelement vertex many\n",
            "line 2: 'element vertex many' where 'element NAME COUNT' is expected",
        ),
        (
            "ply\nformat ascii 1.0\nproperty float x\n",
            "line 3: 'property float x' where 'property TYPE NAME' of an element is expected",
        ),
        ("ply\nformat ascii 1.0\n", "line 3: '' where 'end_header' is expected"),
        (&format!("{head}3 0 1 2\n"), "face 1 names vertex 1, counted from 0, but there are 1"),
        (&format!("{head}3 0 x 2\n"), "line 11: 'x' where a number is expected"),
        (&format!("{head}3 0 0.5 2\n"), "face 1 names vertex 0.5, counted from 0, but there are 1"),
        (
            &format!("{head}-1\n"),
            "face 1 has a list of -1 numbers; a length is a whole number, zero or above",
        ),
        (
            &format!("{head}4000000000 0\n"),
            "face 1 has a list of 4000000000 numbers, and at most 1048576 are read; is this the right file?",
        ),
    ] {
        assert_eq!(message(text), expected);
    }
}
