//! The table of commands. One line each: identity, name in scripts, what it needs, what it takes (if anything), a word or
//! two for the footer, and what it does.

/// One row of the table.
#[derive(Debug, Clone, Copy)]
pub struct Row {
    pub id: Id,
    pub name: &'static str,
    pub section: &'static str,
    pub help: &'static str,
    pub short: &'static str,
    pub argument: Option<&'static str>,
    /// What must be there before it can be done.
    pub needs: Needs,
}

/// What must be there before a command can be done.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Needs {
    Nothing,
    Walker,
    /// A state of the walk, or no curve being computed.
    WalkerOrNoCurve,
    /// A state in which the edge can run.
    Jump,
    /// A command to take back.
    Undo,
    Redo,
    /// A second branch of the walk.
    Branches,
    Curve,
    Pins,
    Parameter,
    /// A view that shows a part of its chart only.
    Zoom,
}

/// Makes [`Id`] and [`ROWS`] of the table.
macro_rules! commands {
    ($($section:literal { $(
        $id:ident $name:literal $needs:ident $(($argument:literal))? $short:literal: $help:literal;
    )* })*) => {
        /// A command's identity.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub enum Id { $($(
            #[doc = $help]
            $id,
        )*)* }

        /// The rows in the order of the help, which is that of [`Id`].
        pub static ROWS: &[Row] = &[$($(
            Row {
                id: Id::$id,
                name: $name,
                section: $section,
                help: $help,
                short: $short,
                argument: commands!(@argument $($argument)?),
                needs: Needs::$needs,
            },
        )*)*];
    };
    (@argument) => { None };
    (@argument $argument:literal) => { Some($argument) };
}

commands! {
    "Walk along the curve" {
        Step "step" Walker ("number of steps") "step": "one step along the equilibrium curve, past limit points too";
        NextEvent "next-event" Walker "next event": "to the next event of the path; at a limit point or a touch, let it happen";
        Jump "jump" Jump "jump": "let edges run at constant control to the next stable state; from a touch, with the new contact";
        Run "run" Walker ("number of states") "run": "run at a pace one can watch, to the next limit point or touch; any key but those of the pace pauses";
        Slower "slower" Nothing "slower": "half as many states a second in a run, at first 20";
        Faster "faster" Nothing "faster": "twice as many";
        MoveTo "move-to" Curve ("contact radius") "move to": "the walker to the state of a contact radius on the curve";
        LargestPull "largest-pull" Curve "to A": "the walker to A, the largest pull of the path: where a dead load lets go";
        Reverse "reverse" Walker "back": "turn round: steps and events are then those of the other way";
        Halve "halve-step" Nothing "half step": "halve the step length";
        Double "double-step" Nothing "double step": "double the step length";
        StepLength "step-length" Nothing ("length") "step length": "the longest step, as a share of every quantity's range";
        Undo "undo" Undo ("number") "undo": "take the last command back, whatever it was; no state is erased";
        Redo "redo" Redo ("number") "redo": "do again what was taken back";
        Branches "branches" Branches ("branch") "branches": "the branches of the walk: what each ended with, and back to it";
        Restart "restart" WalkerOrNoCurve "start": "start again";
        Control "control" Nothing ("control") "control": "control the displacement, the force, or a spring's far end";
        SelectEvent "select-event" Walker ("number") "event": "the walker to the event of this number; a digit does it too";
    }
    "Change the problem" {
        Less "less" Parameter "less": "the selected value less, by its second digit: 0.0025, 0.0024";
        More "more" Parameter "more": "the selected value more, by its second digit";
        MuchLess "much-less" Parameter "much less": "the same by its first digit: 0.003, 0.002";
        MuchMore "much-more" Parameter "much more": "more by its first digit";
        FineLess "fine-less" Parameter "a bit less": "the same by its third digit: 0.00250, 0.00249";
        FineMore "fine-more" Parameter "a bit more": "more by its third digit";
        Free "free" Parameter "free": "let a fit change the selected value, or no longer";
        Fit "fit" Nothing "fit": "fit the free values to the measured curve; Esc takes the best so far";
        Edit "edit" Nothing ("value") "type": "type the selected value, or choose it; in the log: go to the selected event; at the cross-hair: go there; in a study its quantity, on a map its axes";
        Data "data" Nothing ("file, or none") "data": "a measured curve behind the chart, to compare and to fit; none takes it away";
        Assign "set" Nothing ("KEY=VALUE ...") "set": "other values for some keys, as one change";
    }
    "Look" {
        Up "up" Nothing "up": "the line above; in Charts: move up";
        Down "down" Nothing "down": "the line below; in Charts: move down";
        Left "left" Nothing "left": "the value before; in Charts: move left";
        Right "right" Nothing "right": "the next value; in Charts: move right";
        NextPanel "next-panel" Nothing "panel": "the next panel on the screen";
        PreviousPanel "previous-panel" Nothing "panel back": "previous panel";
        Enlarge "enlarge" Nothing "whole": "the selected panel on the whole screen, and back";
        Go "go" Nothing ("curve, inside, map or data") "places": "to a place: c what happens, i inside a state, m how it depends on values, d data and the walk";
        NextView "next-view" Nothing "chart": "the next chart of the place";
        PreviousView "previous-view" Nothing "chart back": "the chart before";
        ChooseView "view" Nothing ("chart") "charts": "any chart by its name; those with nothing to show say why";
        Study "study" Curve ("quantity") "study": "a quantity over the range of the selected value";
        ZoomIn "zoom-in" Curve ("place") "closer": "the chart closer, about the cross-hair or the walker";
        ZoomOut "zoom-out" Curve ("place") "wider": "further away";
        Whole "whole" Zoom "whole": "the whole chart again";
        CrossHair "cross-hair" Curve "cross-hair": "a cross-hair that reads the chart; arrows move it";
        Map "map" Curve ("KEY [KEY, control, approach or force]") "map": "where snaps happen over the selected value; again: the map of it and the adhesion";
        Axes "axes" Nothing "axes": "axes in P/Pc, delta, s/lambda, or raw values";
        Device "device-line" Nothing "device": "show or hide the line of the loading device through the walker";
        Overlays "overlays" Curve ("theory") "theory": "theory over the curve: smooth sphere, exact solution, envelope";
        Pin "pin" Curve "pin": "keep this curve to compare the next ones with";
        Rings "rings" Curve "rings": "the same problem in the ring elements of the paper over the chart, or its exact solution over those; again: away";
        Pins "pins" Pins ("number") "pins": "take pinned curves away";
    }
    "Presets and files" {
        Open "open" Nothing ("preset") "open": "open a preset; D in the list deletes one of your own";
        Save "save" Nothing "save": "save the preset";
        SaveAs "save-as" Nothing ("name") "save as": "save the preset under another name";
        Export "export" Nothing ("file") "export": "write curve, walk or events as CSV or JSON, the session as a script, the screen as text";
        Copy "copy" Nothing "copy": "the state, the events, the chart or the screen into the terminal's clipboard";
    }
    "Program" {
        CommandLine "command-line" Nothing "all": "type a command by its name; Tab completes, up and down bring lines back";
        Mouse "mouse" Nothing "mouse": "take the mouse (click, wheel), or leave it to the terminal to select text";
        About "about" Nothing "about": "what the preset says of itself, and what was changed since";
        Help "help" Nothing "keys": "this help; / searches it";
        Cancel "cancel" Nothing "back": "take typed text back, close, stop a run or a curve";
        Quit "quit" Nothing "quit": "quit; asks only if the preset has unsaved changes";
    }
}

/// The row of a command.
pub fn row_of(id: Id) -> &'static Row {
    &ROWS[id as usize]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn every_id_has_one_row_with_a_name_of_its_own() {
        let ids: HashSet<Id> = ROWS.iter().map(|row| row.id).collect();
        let names: HashSet<&str> = ROWS.iter().map(|row| row.name).collect();
        assert_eq!(ids.len(), ROWS.len());
        assert_eq!(names.len(), ROWS.len());
        for row in ROWS {
            assert_eq!(row_of(row.id).name, row.name);
        }
    }
}
