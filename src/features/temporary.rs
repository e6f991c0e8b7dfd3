//! The naive classifier on `<a, rt, d>`: the paper's hand-made rules that give an unlabelled neighbour a
//! temporary label (section 3.2). The rules are in the label schemes.

use crate::labels::{Label, TemporaryRule};

/// The temporary label of a room from its area in m², axes ratio and number of openings: that of the
/// first rule that holds, or a big room if none does (possible only with NaN).
pub fn classify(rules: &[TemporaryRule], area_m2: f64, axes_ratio: f64, doors: u32) -> Label {
    rules.iter().find(|rule| rule.holds(area_m2, axes_ratio, doors)).map_or(Label::BigRoom, |rule| rule.label)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::labels::{Schemes, Typology};

    /// The entries of D_H printed in the paper (section 3.2): label, a, d, rt.
    #[test]
    fn the_papers_entries() {
        let schemes = Schemes::bundled();
        let rules = schemes.temporary_rules(Typology::new("house").as_ref());
        let agree = [
            (Label::SmallRoom, 3.0, 1, 1.0),
            (Label::BigRoom, 44.0, 2, 1.4),
            (Label::Corridor, 13.0, 8, 3.0),
            (Label::MediumRoom, 15.0, 1, 1.2),
            (Label::Corridor, 9.0, 6, 2.0),
        ];
        for (label, area_m2, doors, axes_ratio) in agree {
            assert_eq!(classify(rules, area_m2, axes_ratio, doors), label, "{area_m2} m²");
        }
    }

    #[test]
    fn the_rules_are_those_of_the_typology() {
        let schemes = Schemes::bundled();
        let of = |typology: &str, area_m2: f64, axes_ratio: f64, doors: u32| {
            classify(schemes.temporary_rules(Typology::new(typology).as_ref()), area_m2, axes_ratio, doors)
        };
        let medium = ["house", "school", "office", "castle"].map(|typology| of(typology, 29.0, 1.2, 1));
        assert_eq!(medium, [Label::BigRoom, Label::SmallRoom, Label::BigRoom, Label::MediumRoom]);
        let joined = ["house", "school", "office", "castle"].map(|typology| of(typology, 110.0, 1.5, 3));
        assert_eq!(joined, [Label::Hall, Label::BigRoom, Label::BigRoom, Label::Hall]);
    }
}
