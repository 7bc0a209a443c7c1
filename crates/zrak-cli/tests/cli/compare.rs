//! `zrak compare`.

use crate::harness::Folder;

/// A picture of 2x1 pixels in PFM.
fn pfm(pixels: [[f32; 3]; 2]) -> Vec<u8> {
    let mut bytes = b"PF\n2 1\n-1.0\n".to_vec();
    bytes.extend(pixels.iter().flatten().flat_map(|value| value.to_le_bytes()));
    bytes
}

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("a.pfm", pfm([[0.5; 3], [1.0; 3]]));
    folder.write("b.pfm", pfm([[0.5; 3], [1.0, 1.0, 1.3]]));
    folder
}

#[test]
fn differences_are_measured() {
    let folder = folder();
    let text = folder.ok("compare a.pfm b.pfm").stdout;
    for words in ["0.300000", "0.050000", "0.122474", "18.24 dB", "1 of 2, the first at (1, 0)"] {
        assert!(text.contains(words), "'{words}' is not in {text}");
    }
    let json = folder.ok("compare a.pfm b.pfm --json").json();
    assert_eq!(json["differing_pixels"], 1);
    assert_eq!(json["identical"], false);
    assert!((json["rmse"].as_f64().unwrap() - 0.122_474).abs() < 1e-6);
    let same = folder.ok("compare a.pfm a.pfm --json --identical").json();
    assert_eq!((&same["identical"], &same["psnr_db"]), (&true.into(), &serde_json::Value::Null));
    assert_eq!(folder.ok("compare a.pfm a.pfm").stdout, "identical: all 2 pixels\n");
}

#[test]
fn limits_decide_the_exit_code() {
    let folder = folder();
    folder.ok("compare a.pfm b.pfm --max-rmse 0.2");
    folder.fails("compare a.pfm b.pfm --max-rmse 0.1", 1, &["over the limit 0.1"]);
    folder.fails("compare a.pfm b.pfm --identical --json", 1, &["not identical"]);
    folder.write("nan.pfm", pfm([[0.5; 3], [f32::NAN; 3]]));
    folder.fails("compare a.pfm nan.pfm --max-rmse 1000", 1, &["NaN"]);
}

#[test]
fn what_cannot_be_compared_is_an_error() {
    let folder = folder();
    folder.ok("render quads --width 4 --spp 1 -q -o c.pfm");
    folder.fails("compare a.pfm c.pfm", 1, &["error:", "2x1 pixels", "4x4"]);
    folder.fails("compare a.pfm none.pfm", 4, &["none.pfm", "No such file"]);
    folder.write("cut.pfm", &pfm([[0.5; 3], [1.0; 3]])[..20]);
    folder.fails("compare cut.pfm a.pfm", 4, &["cut.pfm", "damaged"]);
    folder.fails("compare a.pfm b.pfm --max-rmse -1", 2, &["--max-rmse", "0 or more"]);
    folder.fails("compare a.pfm b.pfm --max-rmse nan", 2, &["--max-rmse"]);
}
