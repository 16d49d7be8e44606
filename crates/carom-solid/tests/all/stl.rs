//! STL files: texts and binary files, and what is wrong with them.

use carom_solid::stl::read;

const TEXT: &str = "solid two\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 -0\nvertex 1 1 0\nendloop\nendfacet\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 1 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid two\n";

fn binary(title: &str, triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
    let mut bytes = title.as_bytes().to_vec();
    bytes.resize(80, b' ');
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for triangle in triangles {
        bytes.extend([0; 12]);
        bytes.extend(triangle.iter().flatten().flat_map(|x| x.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

#[test]
fn texts_and_binary_files_have_the_same_triangles() {
    let text = read(TEXT.as_bytes()).unwrap();
    let [a, b, c, d] = [[0.0, 0.0, 0.0], [1.0, 0.0, -0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    assert_eq!((text.points().len(), text.corners().len(), text.rim()), (4, 2, 4));
    for title in ["", "solid two"] {
        assert_eq!(read(&binary(title, &[[a, b, c], [a, c, d]])).unwrap(), text, "{title}");
    }
}

#[test]
fn wrong_files_are_named() {
    let whole = binary("", &[[[0.0; 3]; 3]; 2]);
    let cut = &TEXT[..TEXT.find("vertex 0 1 0").unwrap()];
    for (bytes, words) in [
        (b"".to_vec(), "triangle 1 cannot be read"),
        (
            cut.as_bytes().to_vec(),
            "it ends early: line 12 is the last one, after 1 triangles, and `endsolid`",
        ),
        (TEXT.as_bytes()[..TEXT.len() - 33].to_vec(), "it ends early: line 13 is the last one"),
        (
            whole[..whole.len() - 20].to_vec(),
            "it ends early: byte 164 is the last one, in triangle 2, and 2 triangles need 184",
        ),
        (whole[..90].to_vec(), "it ends early: byte 90 is the last one, in triangle 1"),
        (TEXT.replace("1 1 0", "1 x 0").into_bytes(), "triangle 1 cannot be read: invalid float"),
        (TEXT.replace("vertex 1 1 0", "vertex 2 0 0").into_bytes(), "triangle 1 has no area"),
        (binary("", &[[[f32::NAN; 3]; 3]]), "triangle 1 cannot be read: its coordinates are not finite"),
        (binary("", &[]), "there are no triangles"),
    ] {
        let error = read(&bytes).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    }
}
