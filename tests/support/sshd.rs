//! A real SSH server on the loopback interface, with its own keys that live as long as the test.
#![allow(dead_code, reason = "each test file uses a part of it")]

use std::{
    fs,
    io::{self, Read, Write},
    net::{TcpListener, TcpStream},
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    thread,
    time::{Duration, Instant},
};

use rustix::net::sockopt::set_socket_linger;
use tempfile::TempDir;

use super::pty::{LIMIT, Pty};

/// Set where these tests must run: without a server they then fail; elsewhere they are skipped.
const WANTED: &str = "PULLOFF_SSH_TESTS";

/// How long a thread of the wire sleeps before it checks whether the wire was cut.
const LOOK: Duration = Duration::from_millis(10);

/// Nothing has come, and the wire is still up.
const NOT_YET: [io::ErrorKind; 3] =
    [io::ErrorKind::WouldBlock, io::ErrorKind::TimedOut, io::ErrorKind::Interrupted];

/// How often a server is started before it counts as unavailable.
const STARTS: usize = 5;

/// Folders outside a normal user's search path that may contain the server.
const PLACES: [&str; 4] = ["/usr/sbin", "/usr/local/sbin", "/sbin", "/usr/lib/ssh"];

/// A server for the user who runs the test.
pub struct Sshd {
    folder: TempDir,
    port: u16,
    daemon: Child,
}

impl Sshd {
    /// Starts one; `None`, with a message on standard error, where there is no OpenSSH and nobody asked for these tests.
    pub fn start() -> Option<Self> {
        // Another process may take the port between the check and the start of the server; then another port is tried.
        let mut tries = (0..STARTS).map(|_| Self::try_start());
        let mut started = tries.next()?;
        while started.is_err()
            && let Some(next) = tries.next()
        {
            started = next;
        }
        match started {
            Ok(sshd) => Some(sshd),
            Err(why) => {
                assert!(std::env::var_os(WANTED).is_none(), "{WANTED} is set, but: {why}");
                // Not `eprintln`, whose output a test program captures.
                let _ = writeln!(
                    io::stderr(),
                    "LEFT OUT, no SSH server: {why} ({WANTED}=1 makes this a failure)"
                );
                None
            }
        }
    }

    fn try_start() -> Result<Self, String> {
        let sshd = find("sshd").ok_or("sshd is not installed")?;
        let (keygen, _) = (find("ssh-keygen").ok_or("ssh-keygen is not installed")?, client()?);
        let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
        let at = |name: &str| folder.path().join(name);
        for key in ["host", "user"] {
            let mut make = Command::new(&keygen);
            make.args(["-q", "-t", "ed25519", "-N", "", "-C", "", "-f"]).arg(at(key));
            let made = make.status().map_err(|error| error.to_string())?;
            assert!(made.success(), "no key was made");
        }
        // Needed by a server that root starts; the system's service would have created it.
        if rustix::process::getuid().is_root() {
            let _ = fs::create_dir_all("/run/sshd");
        }
        let port = free_port();
        let at = |name: &str| at(name).display().to_string();
        let config = format!(
            "ListenAddress 127.0.0.1\nPort {port}\nHostKey {}\nAuthorizedKeysFile {}\nPidFile none\nStrictModes no\n\
             UsePAM no\nPasswordAuthentication no\nKbdInteractiveAuthentication no\n\
             PermitRootLogin prohibit-password\nPrintMotd no\nPrintLastLog no\nLogLevel ERROR\n",
            at("host"),
            at("user.pub"),
        );
        fs::write(at("config"), config).map_err(|error| error.to_string())?;
        let log = fs::File::create(at("log")).map_err(|error| error.to_string())?;
        let mut serve = Command::new(sshd);
        serve.args(["-D", "-e", "-f", &at("config")]).stdin(Stdio::null()).stderr(log);
        let daemon = serve.spawn().map_err(|error| error.to_string())?;
        let mut sshd = Self { folder, port, daemon };
        sshd.wait_until_up()?;
        Ok(sshd)
    }

    /// Also checks that the user may log in: a locked account may not.
    fn wait_until_up(&mut self) -> Result<(), String> {
        let start = Instant::now();
        while !greets(self.port) {
            let ended = self.daemon.try_wait().map_err(|error| error.to_string())?;
            if ended.is_some() || start.elapsed() > LIMIT {
                return Err(format!("sshd does not listen: {}", self.log()));
            }
            thread::sleep(LOOK);
        }
        let mut login = Command::new(client()?);
        login.args(self.client_options(self.port)).arg("true").stdin(Stdio::null());
        let done = login.output().map_err(|error| error.to_string())?;
        if done.status.success() {
            return Ok(());
        }
        Err(format!("no login: {}{}", String::from_utf8_lossy(&done.stderr), self.log()))
    }

    fn log(&self) -> String {
        fs::read_to_string(self.folder.path().join("log")).unwrap_or_default()
    }

    /// Runs a command on the far side of a wire, in a terminal on this side.
    pub fn connect(&self, wire: &Wire, command: &str, cols: u16, rows: u16) -> Pty {
        let mut options = vec!["-tt".to_owned()];
        options.extend(self.client_options(wire.port));
        options.push(command.to_owned());
        let options: Vec<&str> = options.iter().map(String::as_str).collect();
        Pty::spawn(&client().expect("a client"), &options, &[], cols, rows)
    }

    fn client_options(&self, port: u16) -> Vec<String> {
        let identity = self.folder.path().join("user").display().to_string();
        let user = Command::new("id").arg("-un").output().expect("a user");
        let user = String::from_utf8_lossy(&user.stdout).trim().to_owned();
        let mut options: Vec<String> =
            ["-F", "none", "-i", &identity, "-p", &port.to_string()].map(str::to_owned).to_vec();
        for option in [
            "StrictHostKeyChecking=no",
            "UserKnownHostsFile=/dev/null",
            "GlobalKnownHostsFile=/dev/null",
            "IdentitiesOnly=yes",
            "IdentityAgent=none",
            "PreferredAuthentications=publickey",
            "ControlPath=none",
            "EscapeChar=none",
            "LogLevel=ERROR",
        ] {
            options.extend(["-o".to_owned(), option.to_owned()]);
        }
        options.push(format!("{user}@127.0.0.1"));
        options
    }

    /// A wire to the server that can be cut.
    pub fn wire(&self) -> Wire {
        Wire::to(self.port)
    }
}

impl Drop for Sshd {
    fn drop(&mut self) {
        let _ = self.daemon.kill();
        let _ = self.daemon.wait();
    }
}

/// The link between client and server: it carries one connection, and can be cut.
pub struct Wire {
    port: u16,
    cut: Arc<AtomicBool>,
}

impl Wire {
    fn to(server: u16) -> Self {
        let listener = TcpListener::bind(("127.0.0.1", 0)).expect("a port");
        let port = listener.local_addr().expect("an address").port();
        let cut = Arc::new(AtomicBool::new(false));
        let is_cut = Arc::clone(&cut);
        thread::spawn(move || {
            let Ok((near, _)) = listener.accept() else { return };
            let far = TcpStream::connect(("127.0.0.1", server)).expect("the server listens");
            for end in [&near, &far] {
                end.set_read_timeout(Some(LOOK)).expect("a timeout");
                // Closing then resets the connection instead of ending it in order.
                set_socket_linger(end, Some(Duration::ZERO)).expect("no lingering");
            }
            let back = (far.try_clone().expect("a socket"), near.try_clone().expect("a socket"));
            let also = Arc::clone(&is_cut);
            let other = thread::spawn(move || carry(back.0, back.1, &also));
            carry(near, far, &is_cut);
            let _ = other.join();
        });
        Self { port, cut }
    }

    /// Cuts the wire: both ends see a reset.
    pub fn cut(&self) {
        self.cut.store(true, Ordering::SeqCst);
    }
}

impl Drop for Wire {
    fn drop(&mut self) {
        self.cut();
    }
}

/// Copies until one end closes or the wire is cut, and then closes the other end.
fn carry(mut from: TcpStream, mut to: TcpStream, is_cut: &AtomicBool) {
    let mut buffer = [0; 16384];
    while !is_cut.load(Ordering::SeqCst) {
        match from.read(&mut buffer) {
            Ok(count @ 1..) if to.write_all(&buffer[..count]).is_ok() => {}
            Err(error) if NOT_YET.contains(&error.kind()) => {}
            _ => is_cut.store(true, Ordering::SeqCst),
        }
    }
}

/// A port below those that the system assigns to connections, so that none of them takes it before the server does.
fn free_port() -> u16 {
    let free = |port: &u16| TcpListener::bind(("127.0.0.1", *port)).is_ok();
    std::iter::repeat_with(|| fastrand::u16(10_000..32_000)).find(free).expect("a port")
}

/// Whether an SSH server answers at a port.
fn greets(port: u16) -> bool {
    let Ok(mut stream) = TcpStream::connect(("127.0.0.1", port)) else { return false };
    let mut greeting = [0; 4];
    stream.set_read_timeout(Some(LIMIT)).is_ok()
        && stream.read_exact(&mut greeting).is_ok()
        && greeting == *b"SSH-"
}

fn client() -> Result<PathBuf, String> {
    find("ssh").ok_or_else(|| "ssh is not installed".to_owned())
}

fn find(program: &str) -> Option<PathBuf> {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let folders: Vec<PathBuf> = std::env::split_paths(&path).collect();
    let places = PLACES.iter().map(|place| Path::new(place).to_owned());
    folders.into_iter().chain(places).map(|folder| folder.join(program)).find(|file| file.is_file())
}
