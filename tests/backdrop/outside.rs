//! A plan may name any picture on the disk: one outside its folder is read only where a person says so.

use std::path::Path;

use enfilade::store::pictures::is_allowed;
use enfilade::store::save_plan;
use image::ImageFormat;

use super::render::traced;
use super::scan::{encoded, put, walls};
use crate::support;

fn render(plan: &Path, more: &[&str]) -> (String, String) {
    let svg = plan.with_extension("svg");
    let (plan, target) = (plan.to_string_lossy(), svg.to_string_lossy());
    let call = [&["render", &plan, "-o", &target], more].concat();
    let (code, _, said) = support::enfilade(call);
    assert_eq!(code, 0, "{said}");
    (std::fs::read_to_string(&svg).unwrap(), said)
}

#[test]
fn a_render_reads_pictures_in_the_plans_folder_and_where_it_is_told() {
    let root = tempfile::tempdir().unwrap();
    let bytes = encoded(&walls(), ImageFormat::Png);
    let secret = put(root.path(), "private/secret.png", &bytes);
    put(root.path(), "plans/scans/own.png", &bytes);
    let folder = root.path().join("plans");
    let plan = folder.join("a.plan.json");
    let private = root.path().join("private");
    let has_picture = |svg: &str| svg.contains("<image");
    for (path, is_own) in [
        ("scans/own.png", true),
        ("./scans/../scans/own.png", true),
        ("../plans/scans/own.png", true),
        ("../private/secret.png", false),
        ("scans/../../private/secret.png", false),
        (&secret.to_string_lossy(), false),
    ] {
        save_plan(&plan, &traced(path, "")).unwrap();
        let (svg, said) = render(&plan, &[]);
        assert_eq!(has_picture(&svg), is_own, "{path}: {said}");
        assert_eq!(said.contains("outside the plan's folder") && said.contains("--pictures-from"), !is_own, "{said}");
        let (svg, said) = render(&plan, &["--pictures-from", &private.to_string_lossy()]);
        assert!(has_picture(&svg) && said.is_empty(), "{path}: {said}");
        let (svg, _) = render(&plan, &["--no-picture"]);
        assert!(!has_picture(&svg));
    }
    // A link within the folder leads out of it.
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(&secret, folder.join("scans/link.png")).unwrap();
        std::os::unix::fs::symlink(&private, folder.join("scans/folder")).unwrap();
        for path in ["scans/link.png", "scans/folder/secret.png"] {
            save_plan(&plan, &traced(path, "")).unwrap();
            assert!(!has_picture(&render(&plan, &[]).0), "{path}");
        }
    }
}

#[test]
fn a_plan_without_a_folder_has_only_what_is_allowed() {
    let root = tempfile::tempdir().unwrap();
    let picture = put(root.path(), "a.png", b"");
    assert!(!is_allowed(&picture, None, &[]));
    assert!(is_allowed(&picture, None, std::slice::from_ref(&picture)));
    assert!(is_allowed(&picture, None, &[root.path().to_owned()]));
    assert!(is_allowed(&picture, Some(root.path()), &[]));
    // A folder whose name only begins the same is another.
    let near = put(root.path(), "plans-private/a.png", b"");
    std::fs::create_dir(root.path().join("plans")).unwrap();
    assert!(!is_allowed(&near, Some(&root.path().join("plans")), &[]));
}
