use super::{all, find, suggest};
use crate::desc::{ObjectDesc, SceneDesc};

fn build(name: &str) -> SceneDesc {
    (find(name).unwrap().build)()
}

#[test]
fn every_scene_has_its_own_name_and_summary() {
    for builtin in all() {
        let scene = (builtin.build)();
        assert_eq!(scene.name, builtin.name);
        assert_eq!(scene.description, builtin.summary);
        assert_eq!(all().iter().filter(|other| other.name == builtin.name).count(), 1);
    }
}

#[test]
fn every_scene_is_the_same_each_time() {
    for builtin in all() {
        assert_eq!((builtin.build)(), (builtin.build)(), "{}", builtin.name);
    }
}

#[test]
fn the_cover_is_a_full_field() {
    // At most 22 x 22 small spheres, less those too near the big metal one, plus four.
    let cover = build("cover");
    assert!((480..=488).contains(&cover.objects.len()), "{} objects", cover.objects.len());
    let moving = |scene: SceneDesc| {
        let moves =
            |object: &&ObjectDesc| matches!(object, ObjectDesc::Sphere { center_end: Some(_), .. });
        scene.objects.iter().filter(moves).count()
    };
    assert_eq!(moving(cover), 0);
    // Four of five bounce.
    let n_moving = moving(build("bouncing-spheres"));
    assert!((350..430).contains(&n_moving), "{n_moving} moving");
}

#[test]
fn the_final_scene_is_complete() {
    let scene = build("final");
    let sizes: Vec<usize> = scene
        .objects
        .iter()
        .filter_map(|object| match object {
            ObjectDesc::Group { objects, .. } => Some(objects.len()),
            _ => None,
        })
        .collect();
    assert_eq!(sizes, [400, 1000]);
    assert_eq!(scene.objects.len(), 11);
}

#[test]
fn a_misspelt_name_gets_a_suggestion() {
    assert_eq!(suggest("cornel-box"), Some("cornell-box"));
    assert_eq!(suggest("Cover"), Some("cover"));
    assert_eq!(suggest("fianl"), Some("final"));
    assert_eq!(suggest("teapot"), None);
}
