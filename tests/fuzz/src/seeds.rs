//! Small files that are right, one or more for each importer.

use exr::prelude::Compression;
use galpix_sim::source::capture::Files;
use png::ColorType;

use crate::encode::{self, Precision};

const W: usize = 4;
const H: usize = 3;

fn cells<T>(value: impl Fn(usize, usize) -> T) -> Vec<T> {
    (0..W * H).map(|cell| value(cell % W, cell / W)).collect()
}

fn rgb() -> Vec<u8> {
    cells(|x, y| [40 * x as u8, 60 * y as u8, 200]).concat()
}

fn depth() -> Vec<f32> {
    cells(|x, y| 1.0 + x as f32 + 2.0 * y as f32)
}

fn vectors() -> Vec<f32> {
    cells(|x, y| [0.25 * x as f32, 0.5 - y as f32]).concat()
}

fn flo() -> Vec<u8> {
    encode::pieh(W as i32, H as i32, &vectors())
}

fn npy() -> Vec<u8> {
    encode::npy_f4("(3, 4)", &depth())
}

const LINE: &str = "1 0 0 0.5 0 1 0 0 0 0 1 0";

fn kitti() -> String {
    [LINE, &LINE.replace("0.5", "0.6"), &LINE.replace("0.5", "0.7")].join("\n")
}

/// Returns the files beside the one that is varied.
pub fn beside() -> Files {
    let size = (W as u32, H as u32);
    let matrix = |x: f32| format!("1 0 0 {x}\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
    [
        ("c.png", encode::png8(size.0, size.1, ColorType::Rgb, &rgb())),
        ("z.npy", npy()),
        ("f.flo", flo()),
        ("kitti.txt", kitti().into_bytes()),
        ("times.txt", b"0.0\n0.1\n0.2\n".to_vec()),
        ("cameras.txt", b"1 PINHOLE 4 3 4 4 2 1.5\n".to_vec()),
        ("m000000", matrix(0.0).into_bytes()),
        ("m000002", matrix(0.2).into_bytes()),
    ]
    .map(|(name, bytes)| (name.to_owned(), bytes))
    .into()
}

/// Returns the seeds of an importer.
pub fn of(importer: &str) -> Vec<Vec<u8>> {
    match importer {
        "png" => png(),
        "jpeg" => {
            let plain = encode::jpeg(W as u32, H as u32, &rgb());
            vec![encode::jpeg_with_exif(&plain, &encode::exif(6)), plain]
        }
        "exr" => exr(),
        "npy" => {
            let body: Vec<u8> = vectors().iter().flat_map(|v| v.to_be_bytes()).collect();
            let whole: Vec<u8> = cells(|x, y| (100 * x + y) as u16).iter().flat_map(|v| v.to_le_bytes()).collect();
            vec![npy(), encode::npy(2, ">f4", true, "(3, 4, 2)", &body), encode::npy(1, "<u2", false, "(3, 4)", &whole)]
        }
        "npz" => [false, true]
            .map(|compressed| {
                let of_vectors = encode::npy_f4("(3, 4, 2)", &vectors());
                encode::npz(&[("a", npy()), ("b", of_vectors)], compressed)
            })
            .into(),
        "pfm" => {
            let three = cells(|x, y| [x as f32, y as f32, 0.0]).concat();
            vec![encode::pfm(W, H, 1, true, &depth()), encode::pfm(W, H, 3, false, &three)]
        }
        "pieh" => vec![flo(), encode::pieh(W as i32, H as i32, &depth())],
        "poses" => poses(),
        "manifest" => manifests(),
        "obj" => vec![
            b"v 0 0 0\nv 1 0 0 1 0 0\nv 0 1 1\nvn 0 0 1\nf 1 2 3\n".to_vec(),
            b"mtllib m.mtl\no a\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 1\nvt 0 0\nusemtl q\nf -4/1 -3/1 -2/1 -1/1\nl 1 2\n"
                .to_vec(),
        ],
        _ => Vec::new(),
    }
}

fn png() -> Vec<Vec<u8>> {
    let size = (W as u32, H as u32);
    let alpha = cells(|x, y| [9, 8, 7, if x == y { 255 } else { 0 }]).concat();
    let wide = cells(|x, y| [32_768 + 64 * x as u16, 32_768 - 32 * y as u16, 1]).concat();
    vec![
        encode::png8(size.0, size.1, ColorType::Rgb, &rgb()),
        encode::png8(size.0, size.1, ColorType::Rgba, &alpha),
        encode::png8(2, 2, ColorType::Grayscale, &[0, 1, 2, 255]),
        encode::png16(size.0, size.1, ColorType::Grayscale, &cells(|x, y| (300 * x + y) as u16)),
        encode::png16(size.0, size.1, ColorType::Rgb, &wide),
    ]
}

fn exr() -> Vec<Vec<u8>> {
    let list = |names: &[&'static str]| -> Vec<(&'static str, Vec<f32>)> {
        names.iter().enumerate().map(|(at, name)| (*name, cells(|x, y| (x + y + at) as f32 * 0.5))).collect()
    };
    let mut files = vec![
        encode::exr(W, H, Precision::Half, &list(&["X", "Y", "Z", "W"])),
        encode::exr(W, H, Precision::Float, &list(&["VX", "VY", "VZ", "AX", "AY", "AZ", "Z"])),
        encode::exr(W, H, Precision::Float, &list(&["R", "G", "B", "A"])),
        encode::exr(2, 2, Precision::Float, &[("Z", vec![1.0; 4])]),
        encode::exr_window([3, 2], [1, 1], [4, 3], &[("R", vec![0.5; 6]), ("G", vec![0.5; 6]), ("B", vec![0.5; 6])]),
        encode::exr_tiled(W, H, &list(&["R", "G", "B"])),
        encode::exr_parts(W, H, &[("View.Combined", list(&["R", "G", "B"])), ("View.Depth", list(&["Z"]))]),
    ];
    let compressions = [
        Compression::RLE,
        Compression::ZIP1,
        Compression::ZIP16,
        Compression::PIZ,
        Compression::PXR24,
        Compression::B44,
    ];
    files.extend(compressions.map(|compression| encode::exr_with(None, compression, &list(&["R", "G", "B"]))));
    files
}

fn poses() -> Vec<Vec<u8>> {
    let matrix = "1 0 0 0.1\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";
    let frame = |name: &str, x: f32| {
        format!("{{\"file_path\":\"{name}\",\"transform_matrix\":[[1,0,0,{x}],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}}")
    };
    let frames = ["a1", "a2", "a3"].map(|name| frame(name, 0.5)).join(",");
    [
        format!("0 0 0\n{matrix}1 1 1\n{matrix}2 2 2\n{matrix}"),
        "# t\n0.1 0 0 0 0 0 0 1\n0.2 1 0 0 0 0 0 1\n0.3 2 0 0 0 0 0 1\n".to_owned(),
        format!("{{\"camera_angle_x\":0.8,\"w\":4,\"h\":3,\"frames\":[{frames}]}}"),
        "0 0 0 0 0 0 1\n1 0 0 0 0 0 1\n2 0 0 0 0 0 1\n".to_owned(),
        kitti(),
        "#t\n100,0,0,0,1,0,0,0\n200,1,0,0,1,0,0,0\n300,2,0,0,1,0,0,0\n".to_owned(),
        "# i\n1 1 0 0 0 0 0 0 1 a1.png\n\n2 1 0 0 0 1 0 0 1 a2.png\n1 2 3\n3 1 0 0 0 2 0 0 1 a3.png\n\n".to_owned(),
        "0.0\n0.1\n0.2\n".to_owned(),
        matrix.to_owned(),
    ]
    .map(String::into_bytes)
    .into()
}

fn manifests() -> Vec<Vec<u8>> {
    let update = "frames = 4\n[update]\ncolor = \"c.png\"\n";
    let camera = "kind = \"camera\", poses = \"kitti.txt\", format = \"kitti\", intrinsics = [4, 4, 1.5, 1], pose = 1";
    [
        format!(
            "name = \"a\"\n{update}depth = {{ kind = \"speed\" }}\nmotion = {{ kind = \"flow\", file = \"f.flo\" }}\n"
        ),
        format!(
            "{update}depth = {{ kind = \"ray\", file = \"z.npy\", scale = 2, invalid = [1], far = 0 }}\nmotion = \
             {{ {camera}, times = \"times.txt\", rate = 10.0 }}\nbackground = \"camera\"\n[[truth]]\nframe = 1\n\
             color = {{ file = \"c.png\" }}\nmask = \"c.png\"\n"
        ),
        format!(
            "{update}depth = {{ kind = \"disparity\", file = \"z.npy\", baseline = 0.1 }}\nmotion = {{ kind = \
             \"disparity\", file = \"z.npy\", sign = -1, frames = 2 }}\n[update.camera]\n{}\n",
            camera.replace("kind = \"camera\", ", "").replace(", ", "\n").replace("[4\n4\n1.5\n1]", "[4, 4, 1.5, 1]")
        ),
        format!(
            "{update}depth = {{ kind = \"z\", file = \"z.npy\" }}\nmotion = {{ kind = \"flow\", file = \"f.flo\", \
             units = \"picture\", y = \"up\", sign = -1, scale = [1, 2], resize = true }}\nacceleration = {{ kind = \
             \"next-flow\", file = \"f.flo\" }}\noverlay = {{ file = \"c.png\" }}\n[update.hidden]\nkind = \"layer\"\n\
             color = \"c.png\"\ndepth = {{ kind = \"z\", file = \"z.npy\" }}\nmotion = {{ kind = \"flow\", file = \
             \"f.flo\" }}\n"
        ),
    ]
    .map(|text| [b"", text.as_bytes()].concat())
    .into()
}
