use std::collections::BTreeMap;
use std::path::PathBuf;

use super::classify::PredictorOptions;
use super::inputs::from_stdin;
use super::outputs::{Outputs, must_be_folder};
use super::{CliError, Outcome, Subcommand, Terminal, inputs, numbers};
use crate::dataset::RoomNetwork;
use crate::draw::{
    Drawing, Fill, Style, png,
    sheet::{self, Furniture, PageSize},
};
use crate::edit;
use crate::features::{NeighbourLabels, analyse};
use crate::geometry::{polygon, trim_m};
use crate::labels::{Label, Typology};
use crate::plan::{LabelOrigin, Meta, OpeningId, Plan, RoomId, RoomLabel, Scale, ScaleOrigin};
use crate::predict::{ModelSet, Predictions, Predictor};
use crate::robot::{
    grid_map::GridMap,
    grid_plan::{self, GridDoorway, GridRoom},
    map_server::{self, PictureReading},
    segment::{Segmentation, segment},
    semantics::{self, DoorSide, SemanticDoor, SemanticMap, SemanticRoom},
};
use crate::store::{checked_bytes, is_map_yaml, load_map, load_picture_as_map};

/// `enfilade segment`: the rooms of a robot's grid map.
#[derive(clap::Args)]
pub struct SegmentCommand {
    /// A map of map_server (.yaml), or a picture of one with --resolution
    #[arg(value_name = "MAP.yaml|IMAGE")]
    map: PathBuf,
    /// Metres per pixel of a plain picture, in which white is free and all else is not
    #[arg(long, value_name = "METRES", value_parser = numbers::metres)]
    resolution: Option<f64>,
    /// The folder to write to
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Take ids, names and functions of rooms from this semantic map [default: the one that an earlier run left in
    /// the folder]
    #[arg(long, value_name = "NAME_semantics.yaml")]
    update: Option<PathBuf>,
    /// The frame of the semantic map's coordinates
    #[arg(long, value_name = "NAME", default_value = "map")]
    frame: String,
    #[command(flatten)]
    predictor: PredictorOptions,
    /// Label scheme to add to the bundled ones (can be repeated)
    #[arg(long, value_name = "FILE.scheme.toml")]
    scheme: Vec<PathBuf>,
}

impl Subcommand for SegmentCommand {
    const NAME: &'static str = "segment";
    const ABOUT: &'static str = "Find the rooms of a robot's grid map, label them, and write a semantic map";
    const EXAMPLE: &'static str = "enfilade segment floor.yaml -o floor";

    fn run(self, terminal: &mut Terminal) -> Result<Outcome, CliError> {
        must_be_folder(&self.output)?;
        self.check()?;
        let schemes = inputs::schemes(&self.scheme)?;
        let (predictor, models) = self.predictor.read(terminal)?;
        let map = self.load()?;
        let file = from_stdin(&self.map);
        let name = file.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        let semantics_name = format!("{name}_semantics.yaml");
        let before = self.before(&semantics_name)?;

        let segmentation = segment(&map);
        let rooms = grid_plan::rooms(&map, &segmentation);
        let doorways = grid_plan::doorways(&map, &segmentation);
        let known = match &before {
            Some(before) => semantics::known_rooms(&map, &segmentation, &rooms, before),
            None => vec![grid_plan::Known::default(); rooms.len()],
        };
        let known_doorways = match &before {
            Some(before) => semantics::known_doorways(&doorways, &rooms, &known, before),
            None => vec![String::new(); doorways.len()],
        };
        let (plan, room_ids, door_ids) =
            grid_plan::plan(self.meta(&predictor, &name, &map), &rooms, &known, &doorways, &known_doorways)
                .map_err(|what| CliError::new(format!("{}: cannot be a plan: {what}", self.map.display())))?;
        let network = RoomNetwork::new(&plan, &schemes);
        let labels = network.known_labels();
        let said = predictor.predict(network, &labels, None, &models)?;
        let plan = labelled(plan, &said)?;

        let found = Found { map: &map, rooms: &rooms, doorways: &doorways, room_ids: &room_ids, door_ids: &door_ids };
        let semantic = found.semantics(&format!("{name}.yaml"), &self.frame, &plan, &said);
        let mut outputs = Outputs::new(terminal);
        outputs.folder(&self.output)?;
        if before.is_some() && self.update.is_none() {
            // What people wrote into it stays in it.
            outputs.take_over(self.output.join(&semantics_name));
        }
        let analysis = analyse(&plan, &schemes, NeighbourLabels::True);
        let style = Style { fill: Fill::Prediction, ..Style::default() };
        let furniture = Furniture { title: true, legend: true, scale: true };
        let scene = sheet::page(
            &Drawing::new(&plan, &analysis).with_predictions(&said.labels()),
            &style,
            PageSize::Longest(PICTURE_SIDE_PX),
            furniture,
        );
        let mut write = |name: &str, bytes: &[u8]| outputs.save_in(&self.output, name, bytes, terminal);
        let plan_name = format!("{name}.plan.json");
        write(&plan_name, &checked_bytes(&self.output.join(&plan_name), &plan)?)?;
        write(&format!("{name}.png"), &png::png(&scene)?)?;
        write("segmentation.png", &segmentation_png(&map, &segmentation)?)?;
        write(&format!("{name}.pgm"), &map_server::pgm(&map))?;
        let yaml = map_server::yaml(&map, &format!("{name}.pgm"), &semantics_name)?;
        write(&format!("{name}.yaml"), yaml.as_bytes())?;
        write(&semantics_name, semantic.to_yaml()?.as_bytes())?;

        let kept = known.iter().filter(|known| !known.id.is_empty()).count();
        let update = before.map_or(String::new(), |_| format!(", {kept} of the rooms known from before"));
        terminal.report(format!(
            "{}: {}, {}, typology {} ({}){update}",
            self.output.display(),
            counted(rooms.len(), "room"),
            counted(doorways.len(), "doorway"),
            said.choice.set,
            said.choice.because
        ))?;
        Ok(Outcome::Done)
    }
}

/// '1 room', '2 rooms'.
fn counted(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

/// The longer side of the plan's picture in pixels, as in `enfilade render`.
const PICTURE_SIDE_PX: f64 = 1600.0;

impl SegmentCommand {
    /// Whether the options fit the map.
    fn check(&self) -> Result<(), CliError> {
        match (is_map_yaml(&self.map), self.resolution) {
            (true, Some(_)) => {
                Err(CliError::call(format!("{}: has its own resolution; leave out --resolution", self.map.display())))
            }
            (false, None) => Err(CliError::call(format!(
                "{}: a picture needs --resolution, in metres per pixel (usually 0.05)",
                self.map.display()
            ))),
            (false, Some(resolution)) if !(resolution.is_finite() && resolution > 0.0) => {
                Err(CliError::call(format!("--resolution {resolution}: must be more than 0 metres per pixel")))
            }
            _ => Ok(()),
        }
    }

    fn load(&self) -> Result<GridMap, CliError> {
        Ok(match self.resolution {
            None => load_map(&self.map)?,
            Some(resolution) => load_picture_as_map(&from_stdin(&self.map), resolution, PictureReading::PLAIN_PICTURE)?,
        })
    }

    /// The semantic map to take ids from.
    fn before(&self, name: &str) -> Result<Option<SemanticMap>, CliError> {
        let path = match &self.update {
            Some(path) => path.clone(),
            None => self.output.join(name),
        };
        if self.update.is_none() && !path.is_file() {
            return Ok(None);
        }
        let fail = |what: String| CliError::new(format!("{}: {what}", path.display()));
        let size = std::fs::metadata(&path).map_err(|error| fail(error.to_string()))?.len();
        if size > semantics::LARGEST_BYTES as u64 {
            return Err(fail("this file is too large for a semantic map; is it the right one?".to_owned()));
        }
        let text = std::fs::read_to_string(&path).map_err(|error| fail(error.to_string()))?;
        let hint = if self.update.is_some() { "" } else { "; move it away to start again" };
        let read = SemanticMap::from_yaml(&text).map_err(|error| fail(format!("{error}{hint}")))?;
        Ok(Some(read))
    }

    fn meta(&self, predictor: &Predictor, name: &str, map: &GridMap) -> Meta {
        let typology = match &predictor.set {
            ModelSet::Named(name) if name != crate::dataset::sets::STANDARD => Typology::new(name),
            _ => None,
        };
        let scale = Scale {
            origin: ScaleOrigin::Imported,
            metres_per_unit: Some(map.resolution_m),
            note: "resolution of the grid map".to_owned(),
        };
        let source = self.map.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        Meta { name: name.to_owned(), typology, scale, source, ..Meta::default() }
    }
}

/// The plan with the predicted labels of its rooms, marked as predictions.
fn labelled(mut plan: Plan, said: &Predictions) -> Result<Plan, CliError> {
    for room in said.network.rooms.iter().filter(|room| room.label.is_none()) {
        let label = said.label(room.id).map(|label| RoomLabel { label, origin: LabelOrigin::Prediction });
        plan = edit::set_label(&plan, room.id, label)?;
    }
    Ok(plan)
}

/// The results for a map, with their ids in the plan.
struct Found<'a> {
    map: &'a GridMap,
    rooms: &'a [GridRoom],
    doorways: &'a [GridDoorway],
    room_ids: &'a [RoomId],
    door_ids: &'a [OpeningId],
}

impl Found<'_> {
    fn semantics(&self, map_file: &str, frame: &str, plan: &Plan, said: &Predictions) -> SemanticMap {
        let ring = |ring: &[crate::geometry::Point]| ring.iter().map(|point| [point.x, point.y]).collect::<Vec<_>>();
        let of_region: BTreeMap<u32, usize> =
            self.rooms.iter().enumerate().map(|(index, room)| (room.region, index)).collect();
        let room = |(found, &id): (&GridRoom, &RoomId)| {
            let room = plan.room(id);
            // For rooms with a function, the label it implies.
            let known = said.network.rooms.iter().find(|room| room.id == id).and_then(|room| room.label);
            let label = known.or_else(|| said.label(id));
            let centre = semantics::centre(found);
            SemanticRoom {
                id: id.to_string(),
                name: room.map(|room| room.name.clone()).unwrap_or_default(),
                function: room.map(|room| room.function.clone()).unwrap_or_default(),
                label: label.map(Label::letter).unwrap_or_default().to_owned(),
                label_name: label.map(Label::name).unwrap_or_default().to_owned(),
                area: trim_m(polygon::area(&found.outer, &found.holes)),
                centre: [centre.x, centre.y],
                polygon: ring(&found.outer),
                holes: found.holes.iter().map(|hole| ring(hole)).collect(),
            }
        };
        let door = |(doorway, id): (&GridDoorway, &OpeningId)| {
            let [one, other] = doorway.regions.map(|region| of_region.get(&region).copied());
            let (one, other) = (one?, other?);
            let poses = semantics::door_poses(doorway, [&self.rooms[one], &self.rooms[other]]);
            let side = |room: usize, pose| DoorSide { room: self.room_ids[room].to_string(), pose };
            Some(SemanticDoor {
                id: id.to_string(),
                width: trim_m(doorway.width_m()),
                ends: doorway.ends.map(|end| [end.x, end.y]),
                sides: vec![side(one, poses[0]), side(other, poses[1])],
            })
        };
        let origin = self.map.map_from_grid;
        SemanticMap {
            version: semantics::VERSION,
            map: map_file.to_owned(),
            frame: frame.to_owned(),
            resolution: self.map.resolution_m,
            origin: [origin.x_m, origin.y_m, origin.heading_rad],
            typology: said.choice.set.clone(),
            rooms: self.rooms.iter().zip(self.room_ids).map(room).collect(),
            doors: self.doorways.iter().zip(self.door_ids).filter_map(door).collect(),
        }
    }
}

/// The segmentation as a picture of the map's size: every room, and every smaller patch of free space, in
/// its own colour, everything else black.
fn segmentation_png(map: &GridMap, segmentation: &Segmentation) -> Result<Vec<u8>, CliError> {
    let width = u32::try_from(map.width())?;
    let height = u32::try_from(map.height())?;
    let colours: Vec<[u8; 3]> = (0..=segmentation.regions).map(colour).collect();
    let pixels: Vec<u8> = segmentation.region_of_cell.iter().flat_map(|&region| colours[region as usize]).collect();
    let mut bytes = Vec::new();
    let mut encoder = ::png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(::png::ColorType::Rgb);
    encoder.set_depth(::png::BitDepth::Eight);
    encoder.set_compression(::png::Compression::Fast);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&pixels)?;
    writer.finish()?;
    Ok(bytes)
}

/// A colour for each number: black only for 0, no two alike below 2^24, neighbours far apart. It is the
/// number times an odd constant, modulo 2^24.
fn colour(number: u32) -> [u8; 3] {
    /// 2^24 over the golden ratio, made odd: multiples of it are spread evenly (Knuth, vol. 3, 6.4).
    const SPREAD: u32 = 0x9e_3779;
    let [_, red, green, blue] = number.wrapping_mul(SPREAD).to_be_bytes();
    [red, green, blue]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_regions_share_a_colour() {
        let colours: std::collections::BTreeSet<[u8; 3]> = (0..100_000).map(colour).collect();
        assert_eq!(colours.len(), 100_000);
        assert_eq!(colour(0), [0, 0, 0]);
    }
}
