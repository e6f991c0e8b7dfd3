//! How soon the review queue shows wrong labels that were planted among right ones: the share of them within the first 15 % of the
//! queue, beside a random order and the order of plain uncertainty. `docs/review.md` has the table.
//!
//!     cargo run --release --no-default-features --example planted_errors -- [--seeds 3] [--first-seed 1] [--share 0.05] [--looks 0.15] FOLDER...
//!
//! Each folder is a data set of its own. A seed plants other errors: told are the mean over them and, behind ±, the standard deviation.

#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    clippy::disallowed_methods,
    reason = "an example talks to its user"
)]

mod plant;

use std::error::Error;
use std::path::{Path, PathBuf};
use std::time::Instant;

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

fn mean_and_spread(shares: &[f64]) -> String {
    let count = shares.len().max(1) as f64;
    let mean = shares.iter().sum::<f64>() / count;
    let variance = shares.iter().map(|share| (share - mean).powi(2)).sum::<f64>() / (count - 1.0).max(1.0);
    let spread = if shares.len() > 1 { format!(" ± {:.0}", 100.0 * variance.sqrt()) } else { String::new() };
    format!("{:.0}{spread} %", 100.0 * mean)
}

fn main() -> Result<(), Box<dyn Error>> {
    let (mut first_seed, mut seeds, mut share, mut looks, mut most, mut folds) = (1, 3, 0.05, 0.15, usize::MAX, 10);
    let mut only: Option<String> = None;
    let mut folders: Vec<PathBuf> = Vec::new();
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut value = || words.next().ok_or(format!("{word} needs a value"));
        match word.as_str() {
            "--seeds" => seeds = value()?.parse()?,
            "--first-seed" => first_seed = value()?.parse()?,
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
                let (mut shares, mut rooms): ([Vec<f64>; 4], usize) = Default::default();
                let start = Instant::now();
                for seed in first_seed..first_seed + seeds {
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
                    for (shares, order) in shares.iter_mut().zip(&orders) {
                        shares.push(found(order, &planted, looks));
                    }
                    shares[3].push(found(&order, &planted, share));
                }
                let percent = shares.map(|shares| mean_and_spread(&shares));
                println!(
                    "| {} | {rooms} | {} | {} | {} | {} | {} | {} |",
                    folder.display(),
                    wrong.name(),
                    functions.name(),
                    percent[0],
                    percent[1],
                    percent[2],
                    percent[3]
                );
                eprintln!("{:.1} s a queue", start.elapsed().as_secs_f64() / seeds as f64);
            }
        }
    }
    Ok(())
}
