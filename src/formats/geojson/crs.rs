//! Coordinate reference systems by name. The member `crs` is older than RFC 7946, but GIS programs still
//! write it.

use serde_json::Value;

/// What a file says its coordinates are, each with the words for it: 'UTM zone 32 north (EPSG:32632)'.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Crs {
    /// Longitude and latitude, in degrees.
    Geographic(String),
    /// A map projection whose units are metres on the ground, to a part in a thousand or so.
    Metres(String),
    /// Web Mercator, whose units are metres at the equator only.
    WebMercator(String),
    /// A name that says nothing to us.
    Unknown(String),
}

/// National grids in metres that cadastres use most.
const GRIDS: [(u32, &str); 20] = [
    (2056, "the Swiss grid LV95"),
    (2154, "the French grid Lambert-93"),
    (2180, "the Polish grid CS92"),
    (2193, "New Zealand Transverse Mercator"),
    (3003, "the Italian grid Monte Mario, west"),
    (3004, "the Italian grid Monte Mario, east"),
    (3006, "the Swedish grid SWEREF 99 TM"),
    (3035, "the European grid LAEA"),
    (3067, "the Finnish grid TM35FIN"),
    (3301, "the Estonian grid"),
    (5514, "the Czech grid S-JTSK"),
    (6707, "the Italian grid RDN2008, zone 32"),
    (6708, "the Italian grid RDN2008, zone 33"),
    (21781, "the Swiss grid LV03"),
    (27700, "the British National Grid"),
    (28992, "the Dutch grid RD"),
    (31287, "the Austrian grid Lambert"),
    (31370, "the Belgian grid Lambert 72"),
    (31467, "Gauss-Krüger zone 3"),
    (31468, "Gauss-Krüger zone 4"),
];

/// The value of the member `crs`; `None` where it says nothing.
pub(super) fn of(member: &Value) -> Option<Crs> {
    let name = match member {
        Value::String(name) => name.clone(),
        Value::Object(members) => match members.get("properties").unwrap_or(member) {
            // {"type": "EPSG", "properties": {"code": 4326}} was written once; a link names a file or a page.
            Value::Object(properties) => match ["name", "code", "href"].iter().find_map(|key| properties.get(*key)) {
                Some(Value::String(name)) => name.clone(),
                Some(Value::Number(code)) => format!("EPSG:{code}"),
                _ => return None,
            },
            _ => return None,
        },
        _ => return None,
    };
    let name = name.trim();
    if name.is_empty() {
        return None;
    }
    let upper = name.to_uppercase();
    // 'urn:ogc:def:crs:OGC:1.3:CRS84', 'OGC:CRS84', 'CRS84h'; 83 and 27 are the older American ones.
    if let Some(found) = ["CRS84", "CRS83", "CRS27"].into_iter().find(|word| upper.contains(word)) {
        return Some(Crs::Geographic(format!("longitude and latitude ({found})")));
    }
    let code = upper.contains("EPSG").then(|| upper.rsplit(|c: char| !c.is_ascii_digit()).next()).flatten();
    Some(match code.and_then(|digits| digits.parse().ok()) {
        Some(code) => of_epsg(code),
        None if upper.contains("WGS 84") || upper.contains("WGS84") => {
            if upper.contains("UTM") {
                Crs::Metres(format!("a map projection ({name})"))
            } else {
                Crs::Geographic(format!("longitude and latitude ({name})"))
            }
        }
        None => Crs::Unknown(format!("'{}'", name.chars().take(80).collect::<String>())),
    })
}

/// By its code in the register of the EPSG.
fn of_epsg(code: u32) -> Crs {
    let utm = |zone: u32, half: &str| Crs::Metres(format!("UTM zone {zone} {half} (EPSG:{code})"));
    match code {
        32_601..=32_660 => utm(code - 32_600, "north"),
        32_701..=32_760 => utm(code - 32_700, "south"),
        // ETRS89, ED50 and NAD83.
        25_828..=25_838 => utm(code - 25_800, "north"),
        23_028..=23_038 => utm(code - 23_000, "north"),
        26_901..=26_923 => utm(code - 26_900, "north"),
        3857 | 3785 | 900_913 | 102_100 | 102_113 => Crs::WebMercator(format!("Web Mercator (EPSG:{code})")),
        // The register keeps its codes from 4001 to 4999 for degrees; a few of them are of the Earth's centre.
        4001..=4999 if !matches!(code, 4328 | 4936 | 4978) => {
            Crs::Geographic(format!("longitude and latitude (EPSG:{code})"))
        }
        _ => match GRIDS.iter().find(|(grid, _)| *grid == code) {
            Some((_, name)) => Crs::Metres(format!("{name} (EPSG:{code})")),
            None => Crs::Unknown(format!("EPSG:{code}")),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_many_kinds_are_read() {
        let of_name = |name: &str| of(&serde_json::json!({"type": "name", "properties": {"name": name}}));
        let degrees = |words: &str| Some(Crs::Geographic(format!("longitude and latitude ({words})")));
        assert_eq!(of_name("urn:ogc:def:crs:OGC:1.3:CRS84"), degrees("CRS84"));
        assert_eq!(of_name("urn:ogc:def:crs:EPSG::4326"), degrees("EPSG:4326"));
        assert_eq!(of_name("EPSG:4258"), degrees("EPSG:4258"));
        assert_eq!(of_name("http://www.opengis.net/def/crs/EPSG/0/4326"), degrees("EPSG:4326"));
        assert_eq!(
            of_name("urn:ogc:def:crs:EPSG:6.9:32632"),
            Some(Crs::Metres("UTM zone 32 north (EPSG:32632)".into()))
        );
        assert_eq!(of_name("urn:ogc:def:crs:EPSG::25833"), Some(Crs::Metres("UTM zone 33 north (EPSG:25833)".into())));
        assert_eq!(of_name("EPSG:32719"), Some(Crs::Metres("UTM zone 19 south (EPSG:32719)".into())));
        assert_eq!(of_name("urn:ogc:def:crs:EPSG::3857"), Some(Crs::WebMercator("Web Mercator (EPSG:3857)".into())));
        assert_eq!(of_name("EPSG:27700"), Some(Crs::Metres("the British National Grid (EPSG:27700)".into())));
        assert_eq!(of_name("EPSG:2263"), Some(Crs::Unknown("EPSG:2263".into())));
        assert_eq!(of_name("my grid"), Some(Crs::Unknown("'my grid'".into())));
        assert_eq!(of(&serde_json::json!({"type": "EPSG", "properties": {"code": 4326}})), degrees("EPSG:4326"));
        assert_eq!(of(&serde_json::json!("EPSG:4326")), degrees("EPSG:4326"));
        assert_eq!(of(&serde_json::json!(null)), None);
    }
}
