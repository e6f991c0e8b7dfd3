//! What large workspaces cost, on folders of generated plans: storeys of buildings, each a bundled plan under another name.
//! `cargo run --release --no-default-features --features cli --example workspace_figures -- 2000 20000` makes them in the
//! system's folder for temporary files and takes them away again.

#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "it prints what it measures, and fails by panicking")]
#![allow(clippy::disallowed_methods, reason = "measures time, and writes no user's files")]

use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant, SystemTime};

use enfilade::base::work::Work;
use enfilade::classify::models::Models;
use enfilade::edit;
use enfilade::edit::storey::{Keep, copied};
use enfilade::labels::{Schemes, Typology};
use enfilade::plan::Meta;
use enfilade::store::{IndexFile, bundled_plans};
use enfilade::workspace::Workspace;
use enfilade::workspace::index::{self, Recipe};
use enfilade::workspace::query::{self, Order, PlanColumn, Query, RoomColumn};

/// Makes a folder with so many plans: storeys of buildings, each a bundled plan under another name.
fn make(folder: &Path, plans: usize) {
    let bundled = bundled_plans().unwrap();
    for at in 0..plans {
        let (_, plan) = &bundled[at / 4 % bundled.len()];
        let storey = ["basement", "ground floor", "first floor", "2nd floor"][at % 4];
        let next = copied(plan, storey, Keep::All);
        let building = format!("Building {}", at / 4);
        let meta = Meta { name: format!("{building}, {storey}"), building, ..next.meta().clone() };
        let within = folder.join(format!("{:03}", at / 100));
        std::fs::create_dir_all(&within).unwrap();
        let path = within.join(format!("plan-{at:05}.plan.json"));
        std::fs::write(&path, enfilade::formats::plan_json::to_bytes(&edit::set_meta(&next, meta))).unwrap();
        let past = SystemTime::UNIX_EPOCH + Duration::from_secs(1_600_000_000 + at as u64);
        std::fs::File::open(&path).unwrap().set_modified(past).unwrap();
    }
}

/// Resident memory of this process in megabytes; 0 where the system does not tell.
fn resident_mb() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
    line.and_then(|line| line.trim().trim_end_matches(" kB").parse::<f64>().ok()).unwrap_or(0.0) / 1024.0
}

/// Processor time of this process so far, in milliseconds: of all its threads in steps of 10, and of this thread exactly.
fn processor_ms() -> (f64, f64) {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields: Vec<f64> = stat
        .rsplit(") ")
        .next()
        .map(|rest| rest.split(' ').filter_map(|field| field.parse().ok()).collect())
        .unwrap_or_default();
    // User and system time, its own and that of its children (proc(5)), behind the name and the state; 100 ticks a second.
    let all = 10.0 * fields.get(10..14).map_or(0.0, |ticks| ticks.iter().sum::<f64>());
    let own = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let own = own.split(' ').next().and_then(|ns| ns.parse::<f64>().ok()).unwrap_or(0.0) / 1e6;
    (all, own)
}

/// Prints how long something took, and how much processor time: the same on an idle machine with one processor.
fn timed<T>(what: &str, act: impl FnOnce() -> T) -> T {
    let (start, (all, own)) = (Instant::now(), processor_ms());
    let done = act();
    let wall_ms = 1e3 * start.elapsed().as_secs_f64();
    let (all_after, own_after) = processor_ms();
    // Other threads and children may have worked too.
    let (all_ms, own_ms) = (all_after - all, own_after - own);
    let used_ms = if all_ms > own_ms + 20.0 { all_ms } else { own_ms };
    println!("{what}: {used_ms:.1} ms of a processor, {wall_ms:.0} ms by the clock");
    done
}

fn main() {
    let sizes: Vec<usize> = std::env::args().skip(1).filter_map(|word| word.parse().ok()).collect();
    for plans in if sizes.is_empty() { vec![2_000] } else { sizes } {
        let (folder, cache) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        timed(&format!("{plans} plans: write them"), || make(folder.path(), plans));
        let recipe = Recipe::new(Arc::new(Schemes::bundled()), &Models::bundled());
        let before_mb = resident_mb();
        let known = IndexFile::open(cache.path(), folder.path()).unwrap();
        let mut workspace = timed("list the folder, no index", || {
            index::list(folder.path(), &[], &recipe, &Work::quiet()).unwrap().workspace
        });
        let paths: Vec<_> = workspace.files().iter().map(|file| file.path.clone()).collect();
        let files = timed("read and check all, no predictions", || {
            let work = Work::quiet();
            work.map(paths.len(), |at| index::read(folder.path(), &paths[at], None, &recipe, false)).unwrap()
        });
        timed("keep them in the index", || {
            for chunk in files.chunks(256) {
                let kept: Vec<_> = chunk.iter().map(|file| index::to_keep(file, &recipe)).collect();
                known.index.keep(&kept, &[]).unwrap();
            }
        });
        workspace.put(files);
        drop((known, workspace));
        let size = std::fs::metadata(IndexFile::path(cache.path(), folder.path())).unwrap().len();
        println!("index: {:.1} MB", size as f64 / 1e6);
        let workspace: Workspace = timed("open with the index", || {
            let known = IndexFile::open(cache.path(), folder.path()).unwrap();
            let listed = index::list(folder.path(), &known.files, &recipe, &Work::quiet()).unwrap();
            assert_eq!(listed.to_read.len(), 0);
            listed.workspace
        });
        let totals = workspace.totals();
        println!("{} plans, {} rooms; memory {:.0} MB more", totals.plans, totals.rooms, resident_mb() - before_mb);
        assert_eq!(totals.plans, plans);
        let quiet = Work::quiet();
        let stairs = Query { text: "function:stairs".to_owned(), ..Query::default() };
        let school = Query { typology: Some(Typology::new("school")), ..Query::default() };
        timed("search rooms by function", || query::rooms(&workspace, &stairs, Order::by(RoomColumn::Plan), &quiet))
            .unwrap();
        timed("filter plans by typology", || query::plans(&workspace, &school, Order::by(PlanColumn::Name), &quiet))
            .unwrap();
        for &by in PlanColumn::ALL {
            timed(&format!("sort plans by {}", by.word()), || {
                query::plans(&workspace, &Query::default(), Order::by(by), &quiet).unwrap()
            });
        }
        for &by in RoomColumn::ALL {
            timed(&format!("sort rooms by {}", by.word()), || {
                query::rooms(&workspace, &Query::default(), Order::by(by), &quiet).unwrap()
            });
        }
        for command in ["ls -lR .", "find . -type f -printf '%p %s %T@\\n'", "grep -r stairs ."] {
            timed(command, || {
                let mut shell = std::process::Command::new("sh");
                shell.arg("-c").arg(command).current_dir(folder.path()).stdout(std::process::Stdio::null());
                shell.status().unwrap()
            });
        }
    }
}
