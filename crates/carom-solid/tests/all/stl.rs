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

/// The two unit squares of `TEXT` and a third one above them, as solids of one text.
const SOLIDS: &str = "solid lower\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nendloop\nendfacet\nendsolid lower\n\nsolid upper\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0.1\nvertex 1 0 0.1\nvertex 1 1 0.1\nendloop\nendfacet\nendsolid\n";

#[test]
fn a_text_is_read_whole() {
    let both = read(SOLIDS.as_bytes()).unwrap();
    let z = |k: usize| both.corners()[k].map(|n| both.points()[n][2]);
    // The numbers are those of the text, not rounded to four bytes.
    assert_eq!((both.corners().len(), z(0), z(1)), (2, [0.0; 3], [0.1; 3]));
    for text in [
        SOLIDS.to_uppercase(),
        SOLIDS.replace('\n', "\r\n"),
        SOLIDS.replace('\n', "\r"),
        SOLIDS.replace("solid lower", "solid"),
        SOLIDS.replace("lower", "facet of the lower plate"),
        SOLIDS.replace("normal 0 0 1", "normal nan -nan(ind) 1"),
        SOLIDS.replace("\nvertex", "\n\n\t  vertex"),
        format!("\u{feff}\n  {}", SOLIDS.trim_end()),
        format!("{SOLIDS}solid none\nendsolid none"),
    ] {
        assert_eq!(read(text.as_bytes()).unwrap(), both, "{text}");
    }
}

/// Every beginning of a text, and of a binary file, is refused or has all solids that end in it.
#[test]
fn no_beginning_of_a_file_is_read_in_part() {
    for end in 0..SOLIDS.len() {
        // Complete if nothing but a name follows the last `endsolid`.
        let solids: Vec<&str> = SOLIDS[..end].split("endsolid").collect();
        let rest = solids[solids.len() - 1].lines().skip(1).collect::<String>();
        let complete = (solids.len() > 1 && rest.trim().is_empty()).then_some(solids.len() - 1);
        let read = read(&SOLIDS.as_bytes()[..end]);
        assert_eq!(read.map(|surface| surface.corners().len()).ok(), complete, "{end}");
    }
    let corner = |x: f32| [[x, 0.0, 0.0], [x + 1.0, 0.0, 0.0], [x, 1.0, 0.0]];
    for title in ["", "solid two"] {
        let file = binary(title, &[corner(0.0), corner(3.0)]);
        assert_eq!(read(&file).unwrap().corners().len(), 2);
        for end in 0..file.len() {
            assert!(read(&file[..end]).is_err(), "{end}");
        }
        for surplus in [&b"\n"[..], b"end", &file] {
            let error = read(&[&file[..], surplus].concat()).unwrap_err().to_string();
            let bytes = file.len() + surplus.len();
            let words = format!(
                "its header states 2 triangles, which end at byte 184, but the file has {bytes} bytes"
            );
            assert_eq!(error, words);
        }
    }
}

#[test]
fn wrong_files_are_named() {
    let whole = binary("", &[[[0.0; 3]; 3]; 2]);
    let cut = &TEXT[..TEXT.find("vertex 0 1 0").unwrap()];
    for (bytes, words) in [
        (b"".to_vec(), "the file is empty"),
        (b"# a surface of triangles".to_vec(), "it neither begins with `solid`, as a text does, nor"),
        ([TEXT.as_bytes(), b"more"].concat(), "line 17: expected `solid`, found `more`"),
        ([TEXT.as_bytes(), b"sol"].concat(), "it ends early: line 17 is the last one, after 2 triangles"),
        (TEXT.replace("outer loop", "inner loop").into_bytes(), "line 3: expected `outer`, found `inner`"),
        (TEXT.replace("vertex 1 1 0", "vertex 1 1").into_bytes(), "line 7: expected a finite number"),
        (TEXT.replace("1 1 0", "1 inf 0").into_bytes(), "line 6: expected a finite number, found `inf`"),
        (
            cut.as_bytes().to_vec(),
            "it ends early: line 12 is the last one, after 1 triangles, and `vertex` is missing",
        ),
        (TEXT.as_bytes()[..TEXT.len() - 33].to_vec(), "it ends early: line 13 is the last one"),
        (
            whole[..whole.len() - 20].to_vec(),
            "it ends early: byte 164 is the last one, in triangle 2, and 2 triangles need 184",
        ),
        (whole[..90].to_vec(), "it ends early: byte 90 is the last one, in triangle 1"),
        (TEXT.replace("1 1 0", "1 x 0").into_bytes(), "line 6: expected a finite number, found `x`"),
        (TEXT.replace("vertex 1 1 0", "vertex 2 0 0").into_bytes(), "triangle 1 has no area"),
        (binary("", &[[[f32::NAN; 3]; 3]]), "the coordinates of triangle 1 are not finite"),
        (binary("", &[]), "there are no triangles"),
    ] {
        let error = read(&bytes).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    }
}

/// The twelve triangles of the box from `low` to `high`, each face cut from its corner number
/// `turn`.
fn block(low: [f64; 3], high: [f64; 3], turn: usize) -> String {
    let corner = |k: usize| [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { low[axis] } else { high[axis] });
    // Counter-clockwise as seen from outside.
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.iter().flat_map(|face| {
        let at = |k: usize| corner(face[(k + turn) % 4]);
        [[at(0), at(1), at(2)], [at(0), at(2), at(3)]]
    });
    let facet = |triangle: [[f64; 3]; 3]| {
        let corners = triangle.map(|[x, y, z]| format!("vertex {x} {y} {z}\n")).concat();
        format!("facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n")
    };
    format!("solid\n{}endsolid\n", triangles.map(facet).collect::<String>())
}

/// Volume by Gauss's theorem.
fn volume(surface: &carom_solid::Triangles) -> f64 {
    let corners = surface.corners().iter().map(|nodes| nodes.map(|n| surface.points()[n]));
    let product = |[a, b, c]: [[f64; 3]; 3]| {
        a[0] * (b[1] * c[2] - b[2] * c[1])
            + a[1] * (b[2] * c[0] - b[0] * c[2])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
    };
    corners.map(product).sum::<f64>() / 6.0
}

/// Boxes side by side are one surface without the wall between them; boxes that touch along an edge
/// are none.
#[test]
fn solids_that_touch_are_one() {
    let one = block([0.0; 3], [1.0, 2.0, 3.0], 0);
    for turn in 0..4 {
        let both =
            read(format!("{one}{}", block([1.0, 0.0, 0.0], [2.5, 2.0, 3.0], turn)).as_bytes()).unwrap();
        assert_eq!((both.corners().len(), both.inner(), both.rim(), both.points().len()), (20, 4, 0, 12));
        assert!((volume(&both) - 15.0).abs() < 1e-12, "{}", volume(&both));
        let apart =
            read(format!("{one}{}", block([1.5, 0.0, 0.0], [2.5, 2.0, 3.0], turn)).as_bytes()).unwrap();
        assert_eq!((apart.corners().len(), apart.inner(), apart.rim()), (24, 0, 0));
        let edge = read(format!("{one}{}", block([1.0, 2.0, 0.0], [2.5, 3.0, 3.0], turn)).as_bytes());
        assert!(edge.unwrap_err().to_string().contains("meet at one edge"));
    }
    let three = [
        one.as_str(),
        &block([1.0, 0.0, 0.0], [2.0, 2.0, 3.0], 1),
        &block([2.0, 0.0, 0.0], [3.0, 2.0, 3.0], 2),
    ];
    let three = read(three.concat().as_bytes()).unwrap();
    assert_eq!((three.inner(), three.corners().len(), volume(&three)), (8, 28, 18.0));
}
