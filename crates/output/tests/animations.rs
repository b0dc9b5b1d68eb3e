//! Animations, as their decoders see them.

use zeroset_output::format::animation::{Animation, Kind, Timing};

const SIZE: [u32; 2] = [24, 16];

/// A square that moves over a still ramp.
fn frame(number: usize) -> Vec<u8> {
    let [w, h] = SIZE.map(|n| n as usize);
    (0..w * h)
        .flat_map(|i| {
            let (x, y) = (i % w, i / w);
            if (x / 4, y / 4) == (number + 1, 1) {
                [250, 60, 10]
            } else {
                [(10 * x) as u8, (10 * y) as u8, 90]
            }
        })
        .collect()
}

fn written(kind: Kind, rate: f64, frames: usize) -> Vec<u8> {
    let timing = Timing {
        size: SIZE,
        frames: frames as u32,
        rate,
    };
    let mut out = Vec::new();
    let mut animation = Animation::new(&mut out, kind, timing).unwrap();
    (0..frames).for_each(|i| animation.push(&frame(i)).unwrap());
    animation.finish().unwrap();
    out
}

#[test]
fn a_gif_shows_every_frame_in_its_time() {
    let bytes = written(Kind::Gif, 12.5, 4);
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::Indexed);
    let mut decoder = options.read_info(bytes.as_slice()).unwrap();
    assert_eq!([decoder.width(), decoder.height()], SIZE.map(|n| n as u16));
    assert_eq!(decoder.repeat(), gif::Repeat::Infinite);
    let palette = decoder.global_palette().unwrap().to_vec();
    let width = SIZE[0] as usize;
    let mut screen = vec![0; 3 * width * SIZE[1] as usize];
    let mut number = 0;
    while let Some(part) = decoder.read_next_frame().unwrap() {
        assert_eq!(part.delay, 8);
        for (i, index) in part.buffer.iter().enumerate() {
            let (x, y) = (i % usize::from(part.width), i / usize::from(part.width));
            let at = 3 * ((y + usize::from(part.top)) * width + x + usize::from(part.left));
            if part.transparent != Some(*index) {
                let from = 3 * usize::from(*index);
                screen[at..at + 3].copy_from_slice(&palette[from..from + 3]);
            }
        }
        // there are more colours than 255: some are mixed of their neighbours, which are 10 apart
        let mut sum = 0.0;
        for (shown, right) in screen.iter().zip(frame(number)) {
            let off = shown.abs_diff(right);
            assert!(off <= 24, "frame {number}: {shown}, not {right}");
            sum += f64::from(off);
        }
        assert!(sum < 4.0 * screen.len() as f64, "frame {number}: {sum}");
        // after the first one, what stands still is not written again
        assert!(number == 0 || usize::from(part.width) * usize::from(part.height) <= 32);
        number += 1;
    }
    assert_eq!(number, 4);
}

#[test]
fn an_animated_png_shows_every_frame_to_the_bit() {
    let bytes = written(Kind::Apng, 30.0, 3);
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes))
        .read_info()
        .unwrap();
    let animation = *reader.info().animation_control().unwrap();
    assert_eq!((animation.num_frames, animation.num_plays), (3, 0));
    let width = SIZE[0] as usize;
    let mut screen = vec![0; 3 * width * SIZE[1] as usize];
    for number in 0..3 {
        let mut part = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut part).unwrap();
        let about = *reader.info().frame_control().unwrap();
        assert_eq!((about.delay_num, about.delay_den), (1, 30));
        let (w, h) = (about.width as usize, about.height as usize);
        for row in 0..h {
            let at = 3 * ((row + about.y_offset as usize) * width + about.x_offset as usize);
            screen[at..at + 3 * w].copy_from_slice(&part[3 * row * w..3 * (row + 1) * w]);
        }
        assert_eq!(screen, frame(number), "frame {number}");
        assert!(number == 0 || w * h <= 32);
    }
}

#[test]
fn what_was_not_announced_is_refused() {
    let timing = Timing {
        size: SIZE,
        frames: 2,
        rate: 10.0,
    };
    for kind in [Kind::Gif, Kind::Apng, Kind::Y4m] {
        let mut out = Vec::new();
        let mut animation = Animation::new(&mut out, kind, timing).unwrap();
        assert!(animation.push(&[0; 5]).is_err(), "{kind:?}");
    }
    // a PNG says how many frames it has before it has them
    let mut out = Vec::new();
    let mut short = Animation::new(&mut out, Kind::Apng, timing).unwrap();
    short.push(&frame(0)).unwrap();
    assert!(short.finish().is_err());
    assert!(
        Animation::new(
            Vec::new(),
            Kind::Gif,
            Timing {
                rate: 60.0,
                ..timing
            }
        )
        .is_err()
    );
}
