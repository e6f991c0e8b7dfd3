//! How soon the review queue shows wrong labels that were planted among right ones: the share of them within the first 15 % of the
//! queue, beside a random order and the order of plain uncertainty. `docs/review.md` has the table.
//!
//!     cargo run --release --no-default-features --example planted_errors -- [--seeds 3] [--share 0.05] [--looks 0.15] FOLDER...
//!
//! Each folder is a data set of its own.

#![allow(clippy::print_stdout, reason = "an example talks to its user")]

mod plant;

use std::error::Error;
use std::path::{Path, PathBuf};

use enfilade::base::random::Random;
use enfilade::base::work::Work;
use enfilade::classify::models::Models;
use enfilade::formats;
use enfilade::labels::Schemes;
use enfilade::plan::RoomId;
use enfilade::review::{FileSeen, Material, Queue, queue};
use enfilade::store::plans_below;
use plant::{File, Functions, Wrong, found, plant};

fn read(folder: &Path, most: usize) -> Vec<File> {
    let files = plans_below(folder, usize::MAX, |_| false).take(most);
    let plans = |path: PathBuf| {
        let plans = formats::read_file(&path).ok()?.plans;
        Some(File { name: path.display().to_string(), plans })
    };
    files.filter_map(|found| plans(found.path)).collect()
}

fn material(files: &[File], schemes: &Schemes) -> Material {
    Material::new(files.iter().map(|file| FileSeen::new(&file.name, String::new(), &file.plans, schemes)))
}

/// The rooms as they are in the queue.
fn keys(queue: &Queue) -> Vec<(String, RoomId)> {
    queue.entries.iter().map(|entry| (entry.row.file.clone(), entry.room)).collect()
}

/// The rooms whose likeliest label is least likely first.
fn by_uncertainty(queue: &Queue) -> Vec<(String, RoomId)> {
    let mut order: Vec<(f64, (String, RoomId))> =
        queue.entries.iter().zip(keys(queue)).map(|(it, key)| (it.said.probability(it.said.label()), key)).collect();
    order.sort_by(|p, q| p.0.total_cmp(&q.0).then_with(|| p.1.cmp(&q.1)));
    order.into_iter().map(|(_, key)| key).collect()
}

fn main() -> Result<(), Box<dyn Error>> {
    let (mut seeds, mut share, mut looks, mut most, mut folds) = (3, 0.05, 0.15, usize::MAX, 10);
    let mut only: Option<String> = None;
    let mut folders: Vec<PathBuf> = Vec::new();
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or(format!("{word} needs a value"));
        match word.as_str() {
            "--seeds" => seeds = value()?.parse()?,
            "--share" => share = value()?.parse()?,
            "--looks" => looks = value()?.parse()?,
            "--most-files" => most = value()?.parse()?,
            "--folds" => folds = value()?.parse()?,
            "--functions" => only = Some(value()?),
            folder => folders.push(folder.into()),
        }
    }
    let schemes = Schemes::bundled();
    println!("{:.0} % of the labels wrong; found within the first {:.0} % of", 100.0 * share, 100.0 * looks);
    println!(
        "| plans | rooms | wrong label | functions | random order | uncertainty | queue | queue, first {:.0} % |",
        100.0 * share
    );
    println!("| --- | --- | --- | --- | --- | --- | --- | --- |");
    for folder in &folders {
        let files = read(folder, most);
        let clean = material(&files, &schemes);
        let of_functions = Functions::ALL.into_iter().filter(|of| only.as_ref().is_none_or(|only| only == of.name()));
        for functions in of_functions {
            for wrong in Wrong::ALL {
                let (mut sums, mut rooms) = ([0.0; 4], 0);
                for seed in 1..=seeds {
                    let (changed, planted) = plant(&files, clean.networks(), share, wrong, functions, seed);
                    let found_queue =
                        queue(&material(&changed, &schemes), &schemes, &Models::bundled(), folds, 1, &Work::quiet())?;
                    let order = keys(&found_queue);
                    rooms = order.len();
                    let mut random = order.clone();
                    random.sort();
                    // Another seed than that of planting, or the order would know.
                    Random::new(1000 + seed).shuffle(&mut random);
                    let orders = [random, by_uncertainty(&found_queue), order.clone()];
                    for (sum, order) in sums.iter_mut().zip(&orders) {
                        *sum += found(order, &planted, looks);
                    }
                    sums[3] += found(&order, &planted, share);
                }
                let percent = sums.map(|sum| 100.0 * sum / seeds as f64);
                println!(
                    "| {} | {rooms} | {} | {} | {:.0} % | {:.0} % | {:.0} % | {:.0} % |",
                    folder.display(),
                    wrong.name(),
                    functions.name(),
                    percent[0],
                    percent[1],
                    percent[2],
                    percent[3]
                );
            }
        }
    }
    Ok(())
}
