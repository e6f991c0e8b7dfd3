//! What was read twice, in words.

use super::{CliError, Terminal};
use crate::base::wording::count;
use crate::dataset::repeats::{Likeness, Pair, Repeats, Sighting};
use crate::plan::titles::first_of;

/// So many pairs of a kind are listed; a manifest lists all.
const PAIRS_LISTED: usize = 10;

/// Says what was read twice.
pub fn report_repeats(
    sightings: &[Sighting],
    repeats: &Repeats,
    keep: bool,
    terminal: &mut Terminal,
) -> Result<(), CliError> {
    for line in repeats_in_words(sightings, repeats, keep, PAIRS_LISTED) {
        terminal.remark(line)?;
    }
    Ok(())
}

/// What was read twice, in lines.
pub fn repeats_in_words(sightings: &[Sighting], repeats: &Repeats, keep: bool, listed: usize) -> Vec<String> {
    let of = |likeness: Likeness| repeats.pairs.iter().filter(move |pair| pair.likeness == likeness);
    let mut lines = Vec::new();
    let in_one_plan = repeats.left_out.iter().filter(|(place, kept)| place.0 == kept.0);
    let in_one_plan: Vec<String> = in_one_plan
        .map(|(&(plan, room), kept)| {
            let rooms = &sightings[plan].rooms;
            format!("{} is {} again in {}", rooms[room].key, rooms[kept.1].key, sightings[plan].title())
        })
        .collect();
    if repeats.left_out.is_empty() && repeats.pairs.is_empty() {
        return lines;
    }
    let what = if keep { "kept anyway" } else { "each counts once" };
    if !repeats.left_out.is_empty() {
        lines.push(format!("{} read twice; {what}:", count(repeats.left_out.len(), "room")));
    }
    for pair in of(Likeness::Same).take(listed) {
        let (first, second) = (sightings[pair.first].title(), sightings[pair.second].title());
        let all = sightings[pair.second].rooms.len();
        let rooms = if pair.rooms.len() == all {
            format!("all {all} rooms")
        } else {
            format!("{} of {all} rooms", pair.rooms.len())
        };
        lines.push(format!("{:>6}  {second} is {first} again ({rooms})", pair.rooms.len()));
        let contradictions = contradictions(sightings, repeats, pair);
        if !contradictions.is_empty() {
            let kept = if keep { "both are kept" } else { "the first is taken" };
            let rooms = count(contradictions.len(), "room");
            lines.push(format!("        {rooms} with another label there, {kept}: {}", first_of(&contradictions)));
        }
    }
    more(&mut lines, of(Likeness::Same).count(), listed);
    for text in in_one_plan.iter().take(listed) {
        lines.push(format!("     1  {text}"));
    }
    more(&mut lines, in_one_plan.len(), listed);
    if of(Likeness::Twins).next().is_some() {
        lines.push("near twins, kept in one fold (many rooms of one shape in the same places):".to_owned());
    }
    for pair in of(Likeness::Twins).take(listed) {
        let (first, second) = (sightings[pair.first].title(), sightings[pair.second].title());
        lines.push(format!("{:>6}  rooms in common: {first}, {second}", pair.rooms.len()));
    }
    more(&mut lines, of(Likeness::Twins).count(), listed);
    lines
}

fn more(lines: &mut Vec<String>, pairs: usize, listed: usize) {
    if pairs > listed {
        lines.push(format!("        and {} more", pairs - listed));
    }
}

/// Rooms of a pair whose labels differ, each with both labels.
fn contradictions(sightings: &[Sighting], repeats: &Repeats, pair: &Pair) -> Vec<String> {
    let letter = |label: Option<crate::labels::Label>| label.map_or("–", crate::labels::Label::letter);
    let rooms = repeats.contradictions(sightings, pair).into_iter();
    rooms.map(|(p, q)| format!("{} ({}, there {})", p.key, letter(p.label), letter(q.label))).collect()
}
