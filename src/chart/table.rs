//! A chart's data as a table.

use super::{Chart, Marks, Scale};

impl Chart {
    /// The data as CSV: one line per mark with its series and its values on both axes; for bars both ends. `keys` tells
    /// what a dot's key is, in the columns that `names` names.
    ///
    /// # Errors
    /// When the table cannot be written, which lack of memory alone could bring about.
    pub fn csv(&self, names: &[&str], keys: &dyn Fn(usize) -> Vec<String>) -> Result<Vec<u8>, csv::Error> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let title =
            |title: &str, otherwise: &str| if title.is_empty() { otherwise.to_owned() } else { title.to_owned() };
        let (across, up) = (title(&self.across.title, "x"), title(&self.up.title, "y"));
        let has = |is: fn(&Marks) -> bool| self.series.iter().any(|series| is(&series.marks));
        let is_bars = has(|marks| matches!(marks, Marks::Bars(_) | Marks::Levels(_)));
        let is_dots = has(|marks| matches!(marks, Marks::Dots(_)));
        let mut head = vec!["series".to_owned()];
        if is_bars {
            head.extend([format!("{across} from"), format!("{across} to"), format!("{up} from"), format!("{up} to")]);
        } else {
            head.extend([across, up, "deviation".to_owned()]);
        }
        if is_dots {
            head.extend(names.iter().map(|name| (*name).to_owned()));
        }
        writer.write_record(&head)?;
        let number = |scale: &Scale, value: f64| match scale {
            // The middle of a named place is its name.
            Scale::Named(of) => of.get(value.round().max(0.0) as usize).cloned().unwrap_or_default(),
            _ => format!("{}", (value * 1e6).round() / 1e6),
        };
        for series in &self.series {
            let start = |cells: [String; 3]| std::iter::once(series.name.clone()).chain(cells).collect::<Vec<_>>();
            match &series.marks {
                Marks::Bars(bars) | Marks::Levels(bars) => {
                    for bar in bars {
                        let cells = [
                            number(&self.across.scale, bar.across[0]),
                            number(&self.across.scale, bar.across[1]),
                            number(&self.up.scale, bar.up[0]),
                            number(&self.up.scale, bar.up[1]),
                        ];
                        writer.write_record(std::iter::once(series.name.clone()).chain(cells))?;
                    }
                }
                Marks::Dots(dots) => {
                    for dot in dots {
                        let values =
                            [number(&self.across.scale, dot.across), number(&self.up.scale, dot.up), String::new()];
                        writer.write_record(start(values).into_iter().chain(keys(dot.key)))?;
                    }
                }
                Marks::Line(points) => {
                    for point in points {
                        let deviation = number(&Scale::Linear, point.deviation);
                        let values =
                            [number(&self.across.scale, point.across), number(&self.up.scale, point.up), deviation];
                        writer.write_record(start(values))?;
                    }
                }
            }
        }
        writer.into_inner().map_err(|error| csv::Error::from(error.into_error()))
    }
}
