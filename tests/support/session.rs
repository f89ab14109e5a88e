//! A session of the explorer without a terminal: commands in, model out, every effect done inline.
#![allow(dead_code, reason = "each test file uses a part of it")]

use pulloff::explorer::command::by_name;
use pulloff::explorer::session::{Document, Ended, Snapshot};
use pulloff::explorer::{Command, Id, Inline, Model, NodeKind, open, update};
use pulloff::store::Store;

pub struct Session {
    pub model: Model,
    pub driver: Inline,
    pub folder: tempfile::TempDir,
}

impl Session {
    pub fn new(preset: &str) -> Self {
        Self::with(preset, &[])
    }

    /// A session on a preset with other values for some keys.
    pub fn with(preset: &str, assignments: &[&str]) -> Self {
        let folder = tempfile::tempdir().expect("a session");
        let store = Store::at(folder.path().join("presets"), &["trace"]);
        let source = store.resolve(preset).expect("a session");
        let (mut model, effects) = open(store.load(&source, assignments).expect("a session"));
        let driver = Inline::new(store);
        driver.settle(&mut model, effects);
        Self { model, driver, folder }
    }

    pub fn does(&mut self, command: impl Into<Command>) -> &mut Self {
        let effects = update(&mut self.model, command.into());
        self.driver.settle(&mut self.model, effects);
        self
    }

    pub fn all(&mut self, commands: &[Id]) -> &mut Self {
        for command in commands {
            self.does(*command);
        }
        self
    }

    pub fn set(&mut self, key: &'static str, text: &str) -> &mut Self {
        self.does(Command::Set { key: key.into(), text: text.to_owned() })
    }

    /// Saves the session, reads it again, and continues it.
    pub fn resume(&mut self) {
        let bytes = Document::new(&Snapshot::of(&self.model), Ended::Running, 7).json().expect("a session");
        let snapshot = Document::read(&bytes).expect("a session").snapshot().expect("a session");
        let (model, effects) = snapshot.resume(None);
        self.model = model;
        self.driver.settle(&mut self.model, effects);
    }

    pub fn status(&self) -> String {
        by_name(&self.model.status().1)
    }

    pub fn kind(&self) -> NodeKind {
        self.model.history.current().expect("a session").kind.clone()
    }

    pub fn radius(&self) -> f64 {
        self.model.history.current().expect("a session").state.contact_radius
    }
}
