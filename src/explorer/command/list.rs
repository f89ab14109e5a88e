//! The list of commands, one row each: identity, name, usual keys, a word or two for the footer, what it needs
//! ([`availability`](crate::explorer::availability)), what it waits for, whether a script may say it, a description;
//! and then what it takes, and what it does.
//!
//! Each user of the list derives what it needs from the rows: [`command`](super) the identities and their names,
//! [`table`](crate::explorer::table) the rest, with the names that are known there. A missing field has the value in
//! [`CommandRow::PLAIN`](crate::explorer::table::CommandRow::PLAIN).

/// Hands the rows to a macro.
macro_rules! each_command {
    ($make:ident) => {
        $make! {
    "Walk along the curve" {
        Step "step" "Space" "step" walker Curve Yes "one step along the equilibrium curve, past limit points too"
            { run: |model| walk(model, Action::Steps(1)),
            takes: takes("number of steps", |rest| Ok(Command::Steps(rest.count("a number of steps", MOST_STEPS)?))) }
        NextEvent "next-event" "n" "next event" walker Curve Yes
            "to the next event of the path; at a limit point or a touch, let it happen" { run: next_event }
        Jump "jump" "x" "jump" jump Curve Yes
            "let edges run at constant control to the next stable state; from a touch, with the new contact"
            { run: |model| walk(model, Action::Jump) }
        Run "run" "r" "run" walker Curve Yes
            "run at a watchable pace to the next limit point or touch; any key but the pace keys pauses"
            { words: "animate play", run: run_or_stop,
            takes: takes("number of states", |rest| Ok(Command::RunOf(rest.count("a number of states", MOST_STEPS)?))) }
        Slower "slower" "(" "slower" always Nothing Screen "halve the states a second of a run, at first 20"
            { run: |model| scale_pace(model, 0.5) }
        Faster "faster" ")" "faster" always Nothing Screen "twice as many" { run: |model| scale_pace(model, 2.0) }
        MoveTo "move-to" "L" "to A" curve Curve Yes
            "move to A, the largest pull of the path; or to B, the farthest state, to a contact radius, or to an event by number, as a digit does"
            { words: "largest pull peak", run: to_largest_pull,
            takes: takes("A, B, event N, or a contact radius", destination).offering(|_| words(["A", "B", "event"])) }
        Reverse "reverse" "b" "turn" turns InOrder Yes "turn round: steps and events then go the other way"
            { words: "turn direction back", look: turn_round }
        Halve "halve-step" "[" "half step" always InOrder Yes "halve the step length" { look: |model| scale_length(model, 0.5) }
        Double "double-step" "]" "double step" always InOrder Yes "double the step length"
            { look: |model| scale_length(model, 2.0) }
        StepLength "step-length" "" "step length" always InOrder Yes "the longest step, as a share of every quantity's range"
            { takes: takes("length", |rest| Ok(Command::StepLength(rest.length()?))).always() }
        Undo "undo" "u" "undo" undo InOrder Yes "undo the last change of values, pins or walk; no state is erased"
            { words: "back take revert", run: |model| travel(model, Id::Undo, 1), takes: takes("number", |rest| travelled(rest, Id::Undo)) }
        Redo "redo" "Ctrl-R" "redo" redo InOrder Yes "redo what was undone" { run: |model| travel(model, Id::Redo, 1),
            takes: takes("number", |rest| travelled(rest, Id::Redo)) }
        Branches "branches" "B" "branches" branches InOrder Screen "the branches of the walk: how each ended, and a way back"
            { takes: Takes::NOTHING.listing(branches_of) }
        Restart "restart" "Home" "start" walker_or_no_curve Curve Yes "start again" { words: "reset beginning again", run: restart }
        Control "control" "c" "control" always Curve Needs("a control")
            "what the device prescribes: displacement, force, or stiffness" { words: "device",
            takes: takes("control", |rest| rest.assigned("a control", "path.control")).offering(controls) }
    }
    "Change the problem" {
        Less "less" "<" "less" parameter InOrder Selected("KEY=VALUE")
            "decrease the selected value by its second digit (0.0025, 0.0024), a rate by a third of a decade" { run: |model| turn(model, Id::Less, None) }
        More "more" ">" "more" parameter InOrder Selected("KEY=VALUE") "increase the selected value by its second digit, a rate by a third of a decade"
            { run: |model| turn(model, Id::More, None) }
        MuchLess "much-less" "{" "much less" parameter InOrder Selected("KEY=VALUE") "decrease it by its first digit: 0.003, 0.002"
            { run: |model| turn(model, Id::MuchLess, None) }
        MuchMore "much-more" "}" "much more" parameter InOrder Selected("KEY=VALUE") "increase it by its first digit"
            { run: |model| turn(model, Id::MuchMore, None) }
        FineLess "fine-less" "," "a bit less" parameter InOrder Selected("KEY=VALUE")
            "decrease it by its third digit: 0.00250, 0.00249" { run: |model| turn(model, Id::FineLess, None) }
        FineMore "fine-more" "." "a bit more" parameter InOrder Selected("KEY=VALUE") "increase it by its third digit"
            { run: |model| turn(model, Id::FineMore, None) }
        Free "free" "*" "free" parameter InOrder Selected("data.free=KEY,...")
            "let a fit change the selected value, or hold it; KEY,... are all that it may change"
            { run: mark, takes: takes("KEY,...", |rest| rest.assigned("keys", data::FREE)) }
        Fit "fit" "F" "fit" always Nothing Yes "fit the free values to the measured curve; Esc takes the best so far"
            { words: "regression report result", run: fit }
        Edit "edit" "Enter =" "type" always Nothing Selected("KEY=VALUE")
            "type the selected value, or choose it; in the log: go to the selected event; at the cross-hair: go there; in a study: its quantity; on a map: its axes" {}
        Data "data" "" "data" always Nothing Needs("a file, or none")
            "a measured curve behind the chart, to compare and to fit; none removes it"
            { words: "measured experiment csv file remove", takes: takes("file, or none", |rest| rest.assigned("a file", data::FILE)).offering(curves) }
        Assign "set" "" "set" always InOrder Yes "other values for some keys, as one change; KEY=none removes an optional one"
            { words: "unset remove default", takes: takes("KEY=VALUE ...", assigned).going_on(assignments_of).always() }
    }
    "Look" {
        Up "up" "Up k" "up" always Nothing Screen "the line above; in Charts: move up"
            { look: |model| arrow(model, (0.0, 1.0), false) }
        Down "down" "Down j" "down" always Nothing Screen "the line below; in Charts: move down"
            { look: |model| arrow(model, (0.0, -1.0), true) }
        Left "left" "Left h" "left" always Nothing Screen "the previous value; in Charts: move left"
            { look: |model| arrow(model, (-1.0, 0.0), false) }
        Right "right" "Right l" "right" always Nothing Screen "the next value; in Charts: move right"
            { look: |model| arrow(model, (1.0, 0.0), true) }
        NextPanel "next-panel" "Tab" "panel" always Nothing Screen "the next panel on the screen"
            { look: |model| next_panel(model, 1) }
        PreviousPanel "previous-panel" "Shift-Tab" "panel back" always Nothing Screen "previous panel"
            { look: |model| next_panel(model, ScreenPanel::ALL.len() - 1) }
        Enlarge "enlarge" "z" "whole" always Nothing Screen "the selected panel on the whole screen, and back" {}
        Go "go" "g" "places" always Nothing Screen
            "to a place: c what happens, i inside a state, m how it depends on values, d data and the walk"
            { words: "result", takes: takes("curve, inside, map or data", place).offering(places) }
        NextView "next-view" "t" "chart" always Nothing Screen "the next chart of the place"
            { look: |model| model.look_at(reach::next(model, true)) }
        PreviousView "previous-view" "T" "chart back" always Nothing Screen "the previous chart"
            { look: |model| model.look_at(reach::next(model, false)) }
        ChooseView "view" "" "charts" always Nothing Screen "any chart by its name; those with nothing to show say why"
            { takes: takes("chart", view).listing(views) }
        Study "study" "" "study" curve Nothing Needs("a quantity") "a quantity over the range of the selected value, or of the one named"
            { words: "sweep dependence parameter quasi-static limit", takes: takes("quantity [KEY[=[log:]FROM..TO]]", quantity).listing(quantities).going_on(quantities) }
        ZoomIn "zoom-in" "+" "closer" curve Nothing Screen "zoom in, about the cross-hair or the walker"
            { look: |model| look::zoom(model, model.view, true, model.cross.unwrap_or(look::MIDDLE)) }
        ZoomOut "zoom-out" "-" "wider" curve Nothing Screen "zoom out"
            { look: |model| look::zoom(model, model.view, false, model.cross.unwrap_or(look::MIDDLE)) }
        Whole "whole" "f" "whole" zoomed Nothing Screen "the whole chart again" { look: look::whole }
        CrossHair "cross-hair" "i" "cross-hair" curve Nothing Screen "a cross-hair that reads the chart; arrows move it"
            { words: "cursor read", look: look::cross_hair }
        Map "map" "" "map" curve Nothing Screen
            "where snaps happen over the selected value; again: the map of it and the adhesion" { words: "phase diagram threshold onset region", look: look::map,
            takes: takes("KEY[=[log:]FROM..TO] [another, control, approach or force]", axes).going_on(axes_of) }
        Axes "axes" "a" "axes" always Nothing Screen "axes in P/Pc, delta, s/lambda, or raw values" { words: "axis units raw", look: look::axes }
        Overlays "overlays" "y" "theory" curve Nothing Screen
            "theory over the curve: smooth sphere, exact solution, envelope, the line of the loading device"
            { takes: takes("theory", theory).listing(theories) }
        Pin "pin" "p" "pin" curve Curve Yes "keep this curve to compare the next ones with" { words: "compare keep", look: look::pin }
        Rings "rings" "#" "rings" curve InOrder Screen
            "over the chart: the same problem in the ring elements of the paper, or its exact solution over those; again: remove"
            { words: "elements", look: look::in_rings }
        Pins "pins" "P" "pins" pins InOrder Needs("the letter of a pin, or all") "remove a pinned curve; the list says what each shows"
            { words: "remove unpin compare outcomes", takes: takes("letter", pin).listing(pins_of) }
    }
    "Presets and files" {
        Open "open" "o" "open" always Nothing Needs("a preset") "open a preset; D in the list deletes one of your own"
            { words: "load preset file", run: |_| vec![file(Job::List)], takes: takes("preset", preset).going_on(presets) }
        Save "save" "s" "save" always Nothing Yes "save the preset" { words: "w write", run: save_back,
            takes: takes("replace, or a name", saved).offering(|_| vec![Offer::new("replace", "overwrite the file even if it changed on disk")]) }
        SaveAs "save-as" "S" "save as" always Nothing Needs("a name") "save the preset under another name"
            { words: "rename copy", takes: takes("name", saved_as).going_on(names) }
        Export "export" "e" "export" always Nothing Needs("a document and a file")
            "write curve, walk, events, pull or study as CSV or JSON, a figure, the session as a script, the screen as text"
            { words: "figure plot picture svg pdf csv json image script replay", takes: takes("WHAT FILE", exported).going_on(documents) }
        Copy "copy" "Y" "copy" always Nothing Screen
            "copy the state, the events, the chart or the screen to the terminal's clipboard" { words: "clipboard yank" }
    }
    "Program" {
        CommandLine "command-line" ":" "all" always Nothing Screen
            "everything that can be done; typing keeps the lines that match; Tab takes a line, Enter runs it" { run: |_| vec![file(Job::Names)] }
        Mouse "mouse" "m" "mouse" always Nothing Screen
            "take the mouse (click, wheel), or leave it to the terminal to select text" {}
        About "about" "I" "about" always Nothing Screen "what the preset says about itself, what has changed since, and the report of a fit" { words: "original correlations errors" }
        Help "help" "?" "keys" always Nothing Screen "what can be done here, by key and name; Tab: how to read the screen" { words: "manual keys" }
        Cancel "cancel" "Esc" "back" always Nothing Screen "discard typed text, close, stop a run or a curve" { run: cancel }
        Quit "quit" "q Ctrl-C" "quit" always Nothing Yes "quit; --resume comes back; asks about unsaved changes"
            { words: "exit leave wq close bye session resume", look: |model| model.quit = true }
    }
        }
    };
}
pub(crate) use each_command;
