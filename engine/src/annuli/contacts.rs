//! Where the bodies touch: a disc and rings around it.

use std::f64::consts::PI;

/// The most contacts in one state.
pub const MOST_CONTACTS: usize = 64;

/// The contact of two axisymmetric bodies: a central disc, rings around it, or both.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Contacts {
    /// s, a length; 0 where there is no disc.
    pub disc: f64,
    /// [a, b], lengths, from the innermost ring outward.
    pub rings: Vec<[f64; 2]>,
}

/// One edge of a contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Edge {
    /// Its radius, a length.
    pub radius: f64,
    /// +1 where the contact grows with the radius, −1 at the inner edge of a ring.
    pub sign: f64,
}

/// Why contacts are invalid.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum ContactsError {
    /// More than [`MOST_CONTACTS`].
    #[error("{contacts} contacts at once are more than the limit of {most}")]
    TooMany {
        /// How many there are.
        contacts: usize,
        /// How many there may be.
        most: usize,
    },
    /// Edges must ascend.
    #[error("the edge at r = {after} must lie outside the one at r = {before}")]
    NotAscending {
        /// An edge.
        before: f64,
        /// The edge that follows it.
        after: f64,
    },
    /// There is no contact.
    #[error("there is no contact")]
    None,
}

impl Contacts {
    /// A disc alone, of the radius `s`.
    pub fn of_disc(s: f64) -> Self {
        Self { disc: s, rings: Vec::new() }
    }

    /// Whether there is a disc.
    pub fn has_disc(&self) -> bool {
        self.disc > 0.0
    }

    /// Whether there is a disc and nothing else.
    pub fn is_disc(&self) -> bool {
        self.has_disc() && self.rings.is_empty()
    }

    /// Whether there is no contact at all.
    pub fn is_empty(&self) -> bool {
        !self.has_disc() && self.rings.is_empty()
    }

    /// The number of contacts.
    pub fn len(&self) -> usize {
        usize::from(self.has_disc()) + self.rings.len()
    }

    /// The number of edges.
    pub fn edge_count(&self) -> usize {
        usize::from(self.has_disc()) + 2 * self.rings.len()
    }

    /// The edges from the axis outward: s, a₁, b₁, a₂, …
    pub fn edges(&self) -> Vec<Edge> {
        let disc = self.has_disc().then_some(Edge { radius: self.disc, sign: 1.0 });
        let rings = self
            .rings
            .iter()
            .flat_map(|[a, b]| [Edge { radius: *a, sign: -1.0 }, Edge { radius: *b, sign: 1.0 }]);
        disc.into_iter().chain(rings).collect()
    }

    /// The contacts with the same number of edges, at these radii, which need not ascend.
    #[must_use]
    pub fn with_edges(&self, radii: &[f64]) -> Self {
        let (disc, rings) = radii.split_at(usize::from(self.has_disc()).min(radii.len()));
        Self {
            disc: disc.first().copied().unwrap_or(0.0),
            rings: rings.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect(),
        }
    }

    /// The largest radius of contact, 0 where there is none.
    pub fn outermost(&self) -> f64 {
        self.rings.last().map_or(self.disc, |ring| ring[1])
    }

    /// The contacts as [inner, outer], a disc as [0, s].
    pub fn intervals(&self) -> Vec<[f64; 2]> {
        let disc = self.has_disc().then_some([0.0, self.disc]);
        disc.into_iter().chain(self.rings.iter().copied()).collect()
    }

    /// The intervals between contacts, and from the axis to the first ring where there is no disc.
    pub fn gaps(&self) -> Vec<[f64; 2]> {
        let inner = std::iter::once(self.disc).chain(self.rings.iter().map(|ring| ring[1]));
        inner.zip(self.rings.iter().map(|ring| ring[0])).map(|(lo, hi)| [lo, hi]).collect()
    }

    /// The widths that no step may use up: of the disc, of every ring and of every gap between contacts; of a gap
    /// around the axis, its diameter.
    pub fn widths(&self) -> Vec<f64> {
        let disc = self.has_disc().then_some(self.disc);
        let rings = self.rings.iter().map(|[a, b]| b - a);
        let gaps = self.gaps().into_iter().map(|[lo, hi]| if lo > 0.0 { hi - lo } else { 2.0 * hi });
        disc.into_iter().chain(rings).chain(gaps).collect()
    }

    /// The contact area, a length squared.
    pub fn area(&self) -> f64 {
        let rings: f64 = self.rings.iter().map(|[a, b]| (b - a) * (b + a)).sum();
        PI * (self.disc * self.disc + rings)
    }

    /// Checks that these can be contacts.
    ///
    /// # Errors
    /// [`ContactsError`].
    pub fn check(&self) -> Result<(), ContactsError> {
        if self.is_empty() {
            return Err(ContactsError::None);
        }
        if self.len() > MOST_CONTACTS {
            return Err(ContactsError::TooMany { contacts: self.len(), most: MOST_CONTACTS });
        }
        let mut before = 0.0;
        for Edge { radius: after, .. } in self.edges() {
            if !(after > before && after.is_finite()) {
                return Err(ContactsError::NotAscending { before, after });
            }
            before = after;
        }
        Ok(())
    }
}
