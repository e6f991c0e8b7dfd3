use crate::base::hash;
use std::fmt;
use std::str::FromStr;

/// Digits of an id: Crockford's base 32, which has no i, l, o or u to misread.
const DIGITS: &[u8; 32] = b"0123456789abcdefghjkmnpqrstvwxyz";

/// Characters of an id after its letter; 5 bits each.
const LENGTH: usize = 12;

/// Ids have 60 bits: two branches of a repository that each add 100,000 elements of a kind collide with a
/// probability of about 10^-8.
const MASK: u64 = (1 << 60) - 1;

/// A text that is not an id.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct IdError {
    text: String,
    letter: char,
}

impl fmt::Display for IdError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "'{}' is no id: expected '{}' and {LENGTH} of the characters 0-9 a-z without i l o u",
            self.text, self.letter
        )
    }
}

impl std::error::Error for IdError {}

/// Mixes values into 60 bits, the same on every machine and in every version: FNV-1a over the bytes
/// (Fowler, Noll, Vo), then the finaliser of splitmix64 (Steele, Lea, Flood 2014) to spread them.
fn mix(letter: char, parts: &[u64], salt: u64) -> u64 {
    let values = [u64::from(letter), salt].into_iter().chain(parts.iter().copied());
    let mut hash = hash::fnv1a(hash::START, values.flat_map(u64::to_le_bytes));
    hash = (hash ^ (hash >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    hash = (hash ^ (hash >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (hash ^ (hash >> 31)) & MASK
}

macro_rules! id_type {
    ($(#[$doc:meta])* $name:ident, $letter:literal) => {
        $(#[$doc])*
        ///
        /// An id is derived from what the element was when created, not from a counter: two branches of a
        /// repository that add different things give them different ids, so that their files merge, and
        /// the same input gives the same ids. It then never changes.
        #[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub struct $name(u64);

        impl $name {
            /// A new id derived from `parts` (coordinates' bits, other ids, hashed names): the first of
            /// its series that is not `taken`.
            pub fn derive(parts: &[u64], taken: impl Fn(Self) -> bool) -> Self {
                let mut salt = 0;
                loop {
                    let id = Self(mix($letter, parts, salt));
                    if !taken(id) {
                        return id;
                    }
                    salt += 1;
                }
            }

            /// The id for a key in an import's source: the text of an id of this kind is that id
            /// (Enfilade wrote the file); from any other ('R12') one is derived.
            pub fn of_key(key: &str) -> Self {
                key.parse().unwrap_or_else(|_| Self::derive(&[name_bits(key)], |_| false))
            }

            /// The 60 bits, to derive other ids from.
            pub const fn bits(self) -> u64 {
                self.0
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                let mut text = [0u8; LENGTH + 1];
                text[0] = u8::try_from($letter).unwrap_or(b'?');
                for (i, digit) in text[1..].iter_mut().enumerate() {
                    *digit = DIGITS[(self.0 >> (5 * (LENGTH - 1 - i))) as usize & 31];
                }
                f.write_str(std::str::from_utf8(&text).map_err(|_| fmt::Error)?)
            }
        }

        impl fmt::Debug for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                fmt::Display::fmt(self, f)
            }
        }

        impl FromStr for $name {
            type Err = IdError;

            fn from_str(text: &str) -> Result<Self, IdError> {
                let error = || IdError { text: text.chars().take(40).collect(), letter: $letter };
                let digits = text.strip_prefix($letter).filter(|digits| digits.len() == LENGTH).ok_or_else(error)?;
                let mut bits = 0;
                for digit in digits.bytes() {
                    let value = DIGITS.iter().position(|&known| known == digit).ok_or_else(error)?;
                    bits = bits << 5 | value as u64;
                }
                Ok(Self(bits))
            }
        }
    };
}

id_type!(
    /// Identity of a corner, written `c…`.
    CornerId,
    'c'
);
id_type!(
    /// Identity of a wall, written `w…`.
    WallId,
    'w'
);
id_type!(
    /// Identity of a room, written `r…`.
    RoomId,
    'r'
);
id_type!(
    /// Identity of an opening, written `o…`.
    OpeningId,
    'o'
);

id_type!(
    /// Identity of a dimension chain, written `d…`.
    DimensionId,
    'd'
);

/// The identity of any element, for reports and selections.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum ElementId {
    Corner(CornerId),
    Wall(WallId),
    Room(RoomId),
    Opening(OpeningId),
    Dimension(DimensionId),
}

impl ElementId {
    /// Its kind in a word: 'room'.
    pub const fn kind(self) -> &'static str {
        match self {
            Self::Corner(_) => "corner",
            Self::Wall(_) => "wall",
            Self::Room(_) => "room",
            Self::Opening(_) => "opening",
            Self::Dimension(_) => "dimension",
        }
    }
}

impl FromStr for ElementId {
    type Err = IdError;

    /// An id of any kind, by its letter.
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        match text.as_bytes().first() {
            Some(b'c') => text.parse().map(Self::Corner),
            Some(b'w') => text.parse().map(Self::Wall),
            Some(b'o') => text.parse().map(Self::Opening),
            Some(b'd') => text.parse().map(Self::Dimension),
            _ => text.parse().map(Self::Room),
        }
    }
}

impl fmt::Display for ElementId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Corner(id) => id.fmt(f),
            Self::Wall(id) => id.fmt(f),
            Self::Room(id) => id.fmt(f),
            Self::Opening(id) => id.fmt(f),
            Self::Dimension(id) => id.fmt(f),
        }
    }
}

/// The bits of a name, for deriving ids: FNV-1a over its bytes.
pub fn name_bits(name: &str) -> u64 {
    hash::fnv1a(hash::START, name.bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_and_back() {
        let id = RoomId::derive(&[1, 2, 3], |_| false);
        assert_eq!(id.to_string().parse(), Ok(id));
        assert_eq!(id.to_string().len(), 13);
        assert!("r123".parse::<RoomId>().is_err());
        assert!("rüüüüüü".parse::<RoomId>().is_err());
        assert!(id.to_string().replace('r', "c").parse::<RoomId>().is_err());
    }

    #[test]
    fn a_taken_id_gives_the_next_of_its_series() {
        let first = WallId::derive(&[7], |_| false);
        let second = WallId::derive(&[7], |id| id == first);
        assert_ne!(first, second);
        assert_eq!(second, WallId::derive(&[7], |id| id == first));
    }
}
