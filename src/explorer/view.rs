//! What of the curve and the walker is shown, and which part of it: pure data.
//!
//! A window is kept in shares of the whole chart, not in values: it stays on the edge of the contact while the walker
//! moves, stays on a snap while a knob is turned, and means the same on reduced and raw axes.

use serde::{Deserialize, Serialize};

use View::{
    Contact, ContactMap, Cycle, Differences, Energy, ForceApproach, ForcePosition, ForceRadius, ForceTime,
    Gap, Map, Pressure, RadiusApproach, Residuals, Speeds, Stability, Study, Unloading, Walk,
};

/// The panels that can be selected.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ScreenPanel {
    Problem,
    /// The state on which the walker stands.
    Here,
    /// The outcome of the path.
    Result,
    Charts,
    Log,
}

impl ScreenPanel {
    /// All panels, in the order of the Tab key.
    pub const ALL: [Self; 5] = [Self::Problem, Self::Here, Self::Result, Self::Charts, Self::Log];
}

/// What the axes show.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Axes {
    /// `P/P_c`, δ, s/λ.
    Reduced,
    /// The preset's own units.
    Raw,
}

/// The table of views: each with its name, what it shows in one line, and its companions.
macro_rules! views {
    ($($(#[$doc:meta])* $view:ident $name:literal $meaning:literal [$($companion:ident),+];)+) => {
        /// The views of a problem and its walker.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
        #[serde(rename_all = "kebab-case")]
        pub enum View {
            $($(#[$doc])* $view,)+
        }

        impl View {
            /// All views, in their order.
            pub const ALL: [Self; 19] = [$(Self::$view),+];

            /// Its name.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$view => $name,)+
                }
            }

            /// What it shows, in one line.
            pub fn meaning(self) -> &'static str {
                match self {
                    $(Self::$view => $meaning,)+
                }
            }

            /// What is shown beside it if there is room, the most informative first.
            pub fn companions(self) -> [Self; 3] {
                match self {
                    $(Self::$view => [$(Self::$companion),+],)+
                }
            }
        }
    };
}

views! {
    /// P over δ.
    ForceApproach "force-approach" "the force P over the approach" [ForceRadius, Contact, Energy];
    /// P over Δ, the displacement of the device's far end.
    ForcePosition "force-position" "the force P over the position of the device's far end"
        [ForceRadius, Contact, Energy];
    /// P over s, on the same axis of P as [`View::ForceApproach`].
    ForceRadius "force-radius" "the force P over the contact radius s" [ForceApproach, Contact, Energy];
    /// s over δ.
    RadiusApproach "radius-approach" "the contact radius s over the approach"
        [ForceApproach, Energy, Pressure];
    /// The contact pressure p(r) of the walker's state.
    Pressure "pressure" "the contact pressure of the walker's state" [Gap, Contact, ForceApproach];
    /// The deformed gap outside the disc of the walker's state.
    Gap "gap" "the gap around its contact, deformed and undeformed" [Pressure, Contact, ForceApproach];
    /// The contact of the walker's state from above.
    Contact "contact" "its contact from above" [Gap, Pressure, ForceApproach];
    /// The potential of bodies and device over s, with the control held at the walker's value.
    Energy "energy" "the potential over s, the control held" [RadiusApproach, ForceApproach, Pressure];
    /// The quasi-static path with what its jumps dissipate, Fig. 10.
    Unloading "unloading" "the retraction with the energy its jumps lose" [ForceApproach, Pressure, Energy];
    /// The whole loop of loading and unloading with its losses, P over δ.
    Cycle "cycle" "the whole loop of loading and unloading, its hysteresis" [ContactMap, ForceApproach, Pressure];
    /// The contacts along the course of the control.
    ContactMap "contact-map" "where the bodies touch, over the whole loop"
        [Cycle, ForceApproach, ForceRadius];
    /// The law of stability: the adhesion at which each state is a limit point, over the contact radius.
    Stability "stability" "the adhesion at which each state is a limit point"
        [RadiusApproach, ForceApproach, Unloading];
    /// Lines in the plane of two numbers at which snaps begin or end.
    Map "map" "where snaps begin, over two numbers" [Stability, ForceApproach, Unloading];
    /// The distances of the measured points from the curve.
    Residuals "residuals" "how far each measured point is from the curve"
        [ForceApproach, ForceRadius, Pressure];
    /// P over time, in the pull at the rate of the preset.
    ForceTime "force-time" "the force P over time, pulled at path.rate" [ForceApproach, ForceRadius, Energy];
    /// G of the measured rows over the speed of the edge.
    Speeds "speeds" "the energy release rate of measured rows over the speed of the edge"
        [ForceApproach, ForceRadius, Pressure];
    /// P minus that of the pinned curves and of theory, at equal s and at equal δ.
    Differences "differences" "P minus that of pins and theory" [ForceApproach, ForceRadius, RadiusApproach];
    /// The states walked, as a table.
    Walk "walk" "the walked states, as a table" [ForceApproach, Pressure, Energy];
    /// A quantity over the range of the selected value.
    Study "study" "a quantity over the range of the selected value" [ForceApproach, Unloading, ForceRadius];
}

impl View {
    /// Whether it is a table of lines, which has no axes.
    pub fn is_table(self) -> bool {
        self == Self::Walk
    }

    /// The view with this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|view| view.name() == name)
    }

    /// Whether it shows the equilibrium curve, on which walker, pins and overlays have a place.
    pub fn is_curve(self) -> bool {
        matches!(self, Self::ForceApproach | Self::ForcePosition | Self::ForceRadius | Self::RadiusApproach)
    }

    /// Whether a point of it is a place to go to: a state, or a value of the preset.
    pub fn leads_somewhere(self) -> bool {
        self.is_curve() || matches!(self, Self::Study | Self::Map)
    }

    /// Whether it shows forces of a curve but no radius.
    pub fn is_without_radius(self) -> bool {
        matches!(self, Self::ForceApproach | Self::ForcePosition)
    }

    /// Whether the force is on its vertical axis: such views stand side by side and share that axis.
    pub fn is_of_force(self) -> bool {
        matches!(self, Self::ForceApproach | Self::ForcePosition | Self::ForceRadius)
    }

    /// Whether it shows the whole loop of loading and unloading.
    pub fn is_cycle(self) -> bool {
        matches!(self, Self::Cycle | Self::ContactMap)
    }

    /// Whether it shows the inside of one state, which a worker has to compute.
    pub fn is_state(self) -> bool {
        matches!(self, Self::Pressure | Self::Gap | Self::Contact | Self::Energy)
    }

    /// The place to which it belongs.
    pub fn home(self) -> Home {
        Home::ALL.into_iter().find(|home| home.views().contains(&self)).unwrap_or(Home::Curve)
    }

    /// The other views of its place, forward or backward from it, in a cycle.
    pub fn others(self, forward: bool) -> impl Iterator<Item = Self> {
        let views = self.home().views();
        let here = views.iter().position(|view| *view == self).unwrap_or(0);
        let way = move |by| if forward { by } else { views.len() - by };
        (1..views.len()).map(move |by| views[(here + way(by)) % views.len()])
    }
}

/// A place: a question, and the views that answer it. Each view belongs to one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Home {
    Curve,
    Inside,
    Map,
    Data,
}

impl Home {
    /// All places, in the order in which they are offered.
    pub const ALL: [Self; 4] = [Self::Curve, Self::Inside, Self::Map, Self::Data];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Curve => "curve",
            Self::Inside => "inside",
            Self::Map => "map",
            Self::Data => "data",
        }
    }

    /// The question it answers.
    pub fn question(self) -> &'static str {
        match self {
            Self::Curve => "what happens",
            Self::Inside => "what this state looks like",
            Self::Map => "how it depends on the values",
            Self::Data => "whether it agrees with what was measured, and what was walked",
        }
    }

    /// Its views, the main one first.
    pub fn views(self) -> &'static [View] {
        match self {
            Self::Curve => &[
                ForceApproach,
                ForceRadius,
                ForcePosition,
                RadiusApproach,
                ForceTime,
                Unloading,
                Cycle,
                Differences,
            ],
            Self::Inside => &[Gap, Pressure, Contact, Energy, ContactMap],
            Self::Map => &[Study, Map, Stability],
            Self::Data => &[Residuals, Speeds, Walk],
        }
    }

    /// The place with this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|home| home.name() == name)
    }
}

/// Theory drawn over the curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Overlay {
    /// The smooth sphere of the same curvature and adhesion: JKR, or Hertz without adhesion.
    Smooth,
    /// The exact solution of the same gap.
    Exact,
    /// The envelope of small waves, Kesari and Lew.
    Envelope,
    /// The line of the loading device through the walker.
    Device,
}

impl Overlay {
    /// All overlays, in the order in which they are offered.
    pub const ALL: [Self; 4] = [Self::Smooth, Self::Exact, Self::Envelope, Self::Device];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Smooth => "smooth",
            Self::Exact => "exact",
            Self::Envelope => "envelope",
            Self::Device => "device",
        }
    }

    /// The overlay with this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|overlay| overlay.name() == name)
    }
}

/// Which overlays are drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Overlays {
    /// [`Overlay::Smooth`].
    pub smooth: bool,
    /// [`Overlay::Exact`].
    pub exact: bool,
    /// [`Overlay::Envelope`].
    pub envelope: bool,
}

impl Default for Overlays {
    fn default() -> Self {
        Self { smooth: true, exact: false, envelope: false }
    }
}

/// The part of a chart that is shown: from and to along each axis, where 0 and 1 are the ends of the whole.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Window {
    pub x: [f64; 2],
    pub y: [f64; 2],
}

/// The smallest share that is shown: within it, doubles resolve about a million positions.
const CLOSEST: f64 = 1e-9;
/// The largest share: further away there is nothing more to see, but a walk beyond the curve may be visible.
const WIDEST: f64 = 4.0;
/// How far the middle of a window may leave the whole, in wholes.
const AWAY: f64 = 0.5;

impl Window {
    /// The whole chart.
    pub const WHOLE: Self = Self { x: [0.0, 1.0], y: [0.0, 1.0] };

    /// Whether all of the chart is shown, and no more.
    pub fn is_whole(&self) -> bool {
        *self == Self::WHOLE
    }

    /// Whether it is a valid window: finite, ascending, neither too close nor too wide.
    pub fn is_possible(&self) -> bool {
        [self.x, self.y].iter().all(|[lo, hi]| lo.is_finite() && (CLOSEST..=WIDEST).contains(&(hi - lo)))
    }

    /// Whether its middle is past an end of the whole.
    pub fn is_beyond(&self) -> bool {
        [self.x, self.y].iter().any(|[lo, hi]| !(0.0..=1.0).contains(&(0.5 * (lo + hi))))
    }

    /// The magnification compared with the whole.
    pub fn magnification(&self) -> f64 {
        1.0 / (self.x[1] - self.x[0])
    }

    /// Zoomed about a place, in shares of the window; `None` beyond the limits.
    pub fn zoomed(&self, times: f64, about: (f64, f64)) -> Option<Self> {
        let zoomed = |[lo, hi]: [f64; 2], at: f64| {
            let fixed = lo + (hi - lo) * at;
            [fixed - (fixed - lo) / times, fixed + (hi - fixed) / times]
        };
        let window = Self { x: zoomed(self.x, about.0), y: zoomed(self.y, about.1) };
        let allowed = |[lo, hi]: [f64; 2]| (CLOSEST..=WIDEST).contains(&(hi - lo));
        // The whole again, without rounding errors from the way back.
        let near = |a: [f64; 2], b: [f64; 2]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6);
        if near(window.x, [0.0, 1.0]) && near(window.y, [0.0, 1.0]) {
            return Some(Self::WHOLE);
        }
        (allowed(window.x) && allowed(window.y)).then(|| window.moved(0.0, 0.0))
    }

    /// Moved by shares of itself to the right and upwards, as far as there may be something to see.
    #[must_use]
    pub fn moved(&self, right: f64, up: f64) -> Self {
        let moved = |[lo, hi]: [f64; 2], by: f64| {
            let half = 0.5 * (hi - lo);
            let middle = (lo + half + 2.0 * half * by).clamp(-AWAY, 1.0 + AWAY);
            [middle - half, middle + half]
        };
        Self {
            x: if right == 0.0 { self.x } else { moved(self.x, right) },
            y: if up == 0.0 { self.y } else { moved(self.y, up) },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn every_view_has_one_home_a_name_and_never_stands_beside_itself() {
        let all: Vec<View> = Home::ALL.into_iter().flat_map(|home| home.views().iter().copied()).collect();
        let homes: HashSet<View> = all.iter().copied().collect();
        assert_eq!((all.len(), homes), (View::ALL.len(), HashSet::from(View::ALL)));
        let mut names = HashSet::new();
        for view in View::ALL {
            assert!(names.insert(view.name()));
            let mut shown = HashSet::from(view.companions());
            assert!(shown.insert(view) && shown.len() == 4, "{view:?}");
            assert_eq!(View::named(view.name()), Some(view));
            // All round its place, and back.
            let others: Vec<View> = view.others(true).collect();
            assert_eq!(others.len() + 1, view.home().views().len());
            assert!(others.iter().rev().copied().eq(view.others(false)));
        }
        assert!(Home::ALL.into_iter().all(|home| Home::named(home.name()) == Some(home)));
    }

    #[test]
    fn zooming_keeps_the_place_and_comes_back_to_the_whole() {
        let about = (0.25, 0.75);
        let close = Window::WHOLE.zoomed(4.0, about).unwrap();
        assert!((close.magnification() - 4.0).abs() < 1e-12);
        let place = close.x[0] + (close.x[1] - close.x[0]) * about.0;
        assert!((place - 0.25).abs() < 1e-12, "{close:?}");
        assert_eq!(close.zoomed(0.25, about), Some(Window::WHOLE));
    }

    #[test]
    fn a_window_stays_in_reach_and_finite() {
        let mut window = Window::WHOLE;
        let mut closer = 0;
        while let Some(next) = window.zoomed(2.0, (0.3, 0.9)) {
            (window, closer) = (next, closer + 1);
        }
        assert_eq!(closer, 29);
        assert!(window.x[0] < window.x[1] && window.y[0] < window.y[1]);
        let mut window = Window::WHOLE;
        for _ in 0..1000 {
            window = window.moved(0.5, -0.5);
        }
        assert!(window.x[0] < 10.0 && window.y[0] > -10.0);
        assert!((window.magnification() - 1.0).abs() < 1e-9);
    }
}
