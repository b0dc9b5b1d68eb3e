//! `render --transparent`.

use crate::run::Folder;

/// Width, height and the pixels of a PNG with alpha.
fn pixels(bytes: Vec<u8>) -> (u32, Vec<[u8; 4]>) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes))
        .read_info()
        .unwrap();
    let mut out = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut out).unwrap();
    assert_eq!(info.color_type, png::ColorType::Rgba);
    (info.width, out.as_chunks::<4>().0.to_vec())
}

/// A ball that shines by itself in one colour, before a bright sky.
const GLOWING: &str = "show(sphere(1.0), material(color = \"black\", specular = 0, emission = \"#808080\"))\n\
    camera(eye = (0, 0, 5), target = (0, 0, 0), fov = 40)\n\
    sky(top = \"white\", horizon = \"white\", bottom = \"white\", ambient = 0)\n\
    render(aa = supersample(samples = 16), tone = \"standard\", exposure = 0)\n";

#[test]
fn what_is_behind_things_is_left_out() {
    let folder = Folder::with("show(sphere(0.8))\n");
    folder.good("render scene.star --size 48x32 --transparent -o x.png");
    let (width, all) = pixels(folder.read("x.png"));
    let at = |x: u32, y: u32| all[(x + width * y) as usize];
    assert_eq!((at(0, 0)[3], at(24, 16)[3]), (0, 255));
    // a scene of a first line stands on no floor then
    assert_eq!(at(24, 31)[3], 0);
    assert!(
        all.iter().any(|p| (30..226).contains(&p[3])),
        "edges are smooth"
    );
    // over its background it is what it was
    folder.good("render scene.star --size 48x32 --transparent -o x.exr");
    folder.bad(
        "render scene.star --frames 0..2 --transparent -o x.gif",
        2,
        &["x.gif", "no transparent pixels"],
    );
}

#[test]
fn edges_have_the_colour_of_the_thing_alone() {
    let folder = Folder::with(GLOWING);
    let ended = folder.run("render scene.star --size 40x40 --transparent -o x.png");
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    let (_, all) = pixels(folder.read("x.png"));
    let middle = all[20 * 40 + 20];
    assert_eq!(middle[3], 255);
    let edges = all.iter().filter(|p| (40..216).contains(&p[3]));
    let mut count = 0;
    for pixel in edges {
        count += 1;
        // no white of the sky is left in them
        let off = pixel[0].abs_diff(middle[0]);
        assert!(off <= 6, "{pixel:?}, not {middle:?}");
    }
    assert!(count > 10, "{count}");
}
