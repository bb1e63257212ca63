//! What holds for the text of every picture; for tests.

use crate::drawing::Scene;

/// Checks the labels of a picture, and returns their texts.
pub(super) fn texts(scene: &Scene) -> Vec<String> {
    check(scene);
    let labels = scene.labels().iter();
    labels.map(|label| label.text.clone()).collect()
}

/// Fails if a label overlaps another, reaches beyond the picture, or is too small to read.
pub(super) fn check(scene: &Scene) {
    let labels = scene.labels();
    for (i, label) in labels.iter().enumerate() {
        assert!(
            scene.area().holds(&label.area),
            "beyond the picture: {label:?}"
        );
        let side = label.area.width.min(label.area.height);
        assert!(label.text.is_empty() || side > 3.0, "too small: {label:?}");
        for other in &labels[i + 1..] {
            assert!(
                !label.area.overlaps(&other.area),
                "{label:?} over {other:?}"
            );
        }
    }
}
