//! Charts are written, legible as files, and refused where they cannot be drawn.

use zrak_image::read_picture;

use super::*;

fn chart() -> Chart {
    let series = |name: &str, factor: f64| Series {
        name: name.into(),
        points: (0..8).map(|i| (f64::from(1 << i), factor * f64::from(1 << i))).collect(),
    };
    Chart {
        title: "Throughput & <more>".into(),
        x_label: "Threads".into(),
        y_label: "Msamples/s".into(),
        series: vec![series("first", 0.8), series("second", 3.0)],
        log_x: true,
        log_y: true,
    }
}

#[test]
fn svg_holds_the_words_and_is_the_same_each_time() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.svg");
    chart().write_svg(&path).unwrap();
    let svg = std::fs::read_to_string(&path).unwrap();
    for word in
        ["<svg", "Throughput &amp; &lt;more&gt;", "Threads", "Msamples/s", "first", "second"]
    {
        assert!(svg.contains(word), "{word}");
    }
    assert!(svg.contains(COLOURS[0]) && svg.contains(COLOURS[1]));
    chart().write_svg(&path).unwrap();
    assert_eq!(std::fs::read_to_string(&path).unwrap(), svg);
}

#[test]
fn png_has_twice_the_pixels_and_is_drawn_in_the_series_colours() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    chart().write_png(&path).unwrap();
    let picture = read_picture(&path).unwrap();
    assert_eq!(picture.width, 2 * WIDTH_PX as u32);
    assert_eq!(picture.height, 2 * HEIGHT_PX as u32);
    assert_eq!(picture.pixels[0], [1.0; 3]);
    // The middles of lines and markers, for both series: 0072b2 and d55e00.
    for colour in [[0x00, 0x72, 0xb2], [0xd5, 0x5e, 0x00]] {
        let linear = colour.map(|code: usize| zrak_image::srgb8_to_linear_table()[code]);
        let n_pixels = picture.pixels.iter().filter(|&&pixel| pixel == linear).count();
        assert!(n_pixels > 1000, "{n_pixels} pixels of {colour:?}");
    }
}

#[test]
fn one_point_and_equal_points_are_drawn() {
    let folder = tempfile::tempdir().unwrap();
    for points in [vec![(1.0, 1.0)], vec![(0.0, 0.0)], vec![(5.0, 2.0), (5.0, 2.0)]] {
        let series = vec![Series { name: "only".into(), points }];
        let chart = Chart { series, log_x: false, log_y: false, ..chart() };
        chart.write_png(&folder.path().join("a.png")).unwrap();
        chart.write_svg(&folder.path().join("a.svg")).unwrap();
    }
}

#[test]
fn what_cannot_be_drawn_is_an_error_and_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    for (points, words) in [
        (vec![], "no points"),
        (vec![(1.0, f64::NAN)], "point (1, NaN) of 'bad' is not finite"),
        (vec![(1.0, 0.0)], "no place on a logarithmic axis"),
        (vec![(-1.0, 1.0)], "no place on a logarithmic axis"),
    ] {
        let series = vec![Series { name: "bad".into(), points }];
        let error = Chart { series, ..chart() }.write_png(&path).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::InvalidInput);
        assert!(error.to_string().contains(words), "{error}");
    }
    assert!(!path.exists());
}

#[test]
fn tick_labels_are_plain_where_they_can_be() {
    for (value, label) in [
        (0.0, "0"),
        (0.1, "0.1"),
        (0.1 + 0.2, "0.3"),
        (-2.5, "-2.5"),
        (10_000.0, "10000"),
        (1e-5, "1e-5"),
        (2e9, "2e9"),
    ] {
        assert_eq!(tick_label(value), label);
    }
}
