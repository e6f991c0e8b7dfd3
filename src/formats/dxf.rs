//! DXF for CAD programs: one drawing in true size on layers named as the US National CAD Standard (AIA) does. Release
//! 2000 (AC1015), which every CAD program of the last twenty years reads. The same plan always gives the same bytes.

mod drawing;
mod text;

use super::options::Choice;
use super::registry::Refused;
use super::{Export, Exporter, Format, FormatOption, Lost, NamedBytes, NamedPlan, Options};
use crate::base::wording::count;
use crate::labels::Schemes;
use crate::plan::Plan;

/// DXF, to be read by CAD programs.
pub const FORMAT: Format = Format {
    id: "dxf",
    name: "DXF",
    endings: &["dxf"],
    about: "A drawing for CAD programs: walls as closed outlines, doors and windows as blocks, rooms as polylines, on \
            layers such as A-WALL, A-DOOR and A-AREA",
    importer: None,
    exporter: Some(&Dxf),
};

static UNITS: Choice =
    Choice { name: "units", words: &["metres", "millimetres"], help: "The unit of the drawing, which the file states" };

struct Dxf;

impl Exporter for Dxf {
    fn options(&self) -> &'static [FormatOption] {
        const { &[FormatOption::Choice(&UNITS)] }
    }

    fn write(&self, plans: &[NamedPlan<'_>], schemes: &Schemes, options: &Options) -> Result<Export, Refused> {
        let in_millimetres = options.choice(&UNITS) == "millimetres";
        let mut export = Export::default();
        for NamedPlan { stem, plan } in plans {
            let bytes = drawing::write(plan, schemes, in_millimetres).into_bytes();
            export.files.push(NamedBytes { name: format!("{stem}.dxf"), bytes });
            let lost = lost(plan).into_iter();
            export.lost.extend(lost.map(|what| Lost { stem: (*stem).to_owned(), what }));
        }
        Ok(export)
    }
}

/// What a drawing does not keep, in words.
fn lost(plan: &Plan) -> Vec<String> {
    let labels = plan.rooms().filter(|(_, room)| room.label.is_some()).count();
    let mut lost: Vec<String> = Vec::new();
    lost.extend(plan.backdrop().map(|_| "the traced picture".to_owned()));
    lost.extend((!plan.guides().is_empty()).then(|| count(plan.guides().len(), "guide")));
    lost.extend((labels > 0).then(|| format!("the labels of {}", count(labels, "room"))));
    lost
}
