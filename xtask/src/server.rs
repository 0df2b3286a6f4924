//! Static files on this machine, with the headers that a measuring page needs.

use core::net::{Ipv4Addr, SocketAddr};
use std::fs::{self, File};
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;
use std::thread;

use anyhow::{Context, Result, anyhow};
use tiny_http::{Header, Method, Request, Response, Server};

/// Requests answered at the same time: one slow reader must not hold up the page.
const WORKERS: usize = 4;

/// A running server; it stops with the program.
#[derive(Debug)]
pub(crate) struct Running {
    address: SocketAddr,
    workers: Vec<thread::JoinHandle<()>>,
}

impl Running {
    /// Serves `root` on 127.0.0.1; port 0 takes any free one.
    ///
    /// # Errors
    ///
    /// If there is nothing to serve, or the port is taken.
    pub(crate) fn start(root: &Path, port: u16) -> Result<Self> {
        // Symbolic links are resolved once here, and each file must lie below the result.
        let root = root.canonicalize().with_context(|| format!("nothing to serve at {}", root.display()))?;
        let server = Server::http((Ipv4Addr::LOCALHOST, port))
            .map_err(|error| anyhow!("cannot serve on 127.0.0.1:{port}: {error}; try another --port"))?;
        let address = server.server_addr().to_ip().context("the server has no address")?;
        let (server, root) = (Arc::new(server), Arc::new(root));
        let worker = || {
            let (server, root) = (Arc::clone(&server), Arc::clone(&root));
            thread::spawn(move || {
                while let Ok(request) = server.recv() {
                    answer(request, &root);
                }
            })
        };
        Ok(Self { address, workers: (0..WORKERS).map(|_| worker()).collect() })
    }

    /// Address of the page.
    #[must_use]
    pub(crate) fn url(&self) -> String {
        format!("http://{}/", self.address)
    }

    /// Serves until the program is stopped.
    pub(crate) fn wait(self) {
        for worker in self.workers {
            let _ = worker.join();
        }
    }
}

/// Answers one request. A reader that went away is no concern of ours, so failures to send are ignored.
fn answer(request: Request, root: &Path) {
    if !matches!(request.method(), Method::Get | Method::Head) {
        let _ = request.respond(text(405, "only GET and HEAD"));
        return;
    }
    let found = find(root, request.url());
    let opened = found.as_ref().and_then(|path| File::open(path).ok());
    let _ = match (found, opened) {
        (Some(path), Some(file)) => {
            let response = HEADERS
                .iter()
                .fold(Response::from_file(file), |r, (name, value)| r.with_header(header(name, value)));
            request.respond(response.with_header(header("Content-Type", mime(&path))))
        }
        _ => request.respond(text(404, "no such file")),
    };
}

/// Isolation, so that timers are fine-grained; and no caching, since the page is rebuilt while one works.
const HEADERS: [(&str, &str); 5] = [
    ("Cross-Origin-Opener-Policy", "same-origin"),
    ("Cross-Origin-Embedder-Policy", "require-corp"),
    ("Cross-Origin-Resource-Policy", "same-origin"),
    ("Cache-Control", "no-cache"),
    ("X-Content-Type-Options", "nosniff"),
];

fn header(name: &str, value: &str) -> Header {
    // Our own constants: they are ASCII without line breaks.
    Header::from_bytes(name, value).expect("a valid header")
}

fn text(status: u16, text: &str) -> Response<std::io::Cursor<Vec<u8>>> {
    Response::from_string(text).with_status_code(status)
}

/// The file that a request's address names, if it lies below `root` (canonical).
fn find(root: &Path, url: &str) -> Option<PathBuf> {
    let path = url.split(['?', '#']).next()?;
    let decoded = decode(path)?;
    let relative = Path::new(decoded.trim_start_matches('/'));
    // Plain names only: no `..`, no drive, nothing absolute.
    if !relative.components().all(|part| matches!(part, Component::Normal(_))) {
        return None;
    }
    let mut file = root.join(relative).canonicalize().ok()?;
    if file.is_dir() {
        file = file.join("index.html").canonicalize().ok()?;
    }
    // A symbolic link may still lead out.
    (file.starts_with(root) && fs::metadata(&file).is_ok_and(|m| m.is_file())).then_some(file)
}

/// Undoes percent-encoding; `None` if that is not text, or holds what no file name does.
fn decode(path: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(path.len());
    let mut rest = path.bytes();
    while let Some(byte) = rest.next() {
        bytes.push(match byte {
            b'%' => {
                let mut digit = || char::from(rest.next()?).to_digit(16);
                u8::try_from(digit()? * 16 + digit()?).ok()?
            }
            byte => byte,
        });
    }
    String::from_utf8(bytes).ok().filter(|text| !text.contains(['\0', '\\']))
}

/// Media type by extension.
fn mime(path: &Path) -> &'static str {
    match path.extension().and_then(|e| e.to_str()).unwrap_or_default() {
        "html" => "text/html; charset=utf-8",
        "js" | "mjs" => "text/javascript; charset=utf-8",
        "css" => "text/css; charset=utf-8",
        "json" | "map" => "application/json",
        "wasm" => "application/wasm",
        "svg" => "image/svg+xml",
        "png" => "image/png",
        "jpg" | "jpeg" => "image/jpeg",
        "gif" => "image/gif",
        "webp" => "image/webp",
        "ico" => "image/x-icon",
        "woff2" => "font/woff2",
        "txt" => "text/plain; charset=utf-8",
        "glb" | "vrm" => "model/gltf-binary",
        "gltf" => "model/gltf+json",
        _ => "application/octet-stream",
    }
}

#[cfg(test)]
mod tests {
    use std::io::{Read, Write};
    use std::net::TcpStream;

    use super::*;

    /// A folder with a page, and beside it a file that must not be reached.
    struct Site(PathBuf);

    impl Site {
        fn new(name: &str) -> Self {
            let dir = std::env::temp_dir().join(format!("sinew-server-{name}-{}", std::process::id()));
            fs::create_dir_all(dir.join("site/a b")).unwrap();
            fs::write(dir.join("secret"), "secret").unwrap();
            fs::write(dir.join("site/index.html"), "page").unwrap();
            fs::write(dir.join("site/a b/m.wasm"), "module").unwrap();
            Self(dir)
        }

        /// The answer to one line as sent, without a client that would tidy it.
        fn get(&self, line: &str) -> String {
            let running = Running::start(&self.0.join("site"), 0).unwrap();
            let mut stream = TcpStream::connect(running.address).unwrap();
            write!(stream, "{line} HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n").unwrap();
            let mut answer = String::new();
            stream.read_to_string(&mut answer).unwrap();
            answer
        }
    }

    impl Drop for Site {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    #[test]
    fn files_come_with_type_and_isolation() {
        let site = Site::new("files");
        let page = site.get("GET /?x=1");
        assert!(page.starts_with("HTTP/1.1 200") && page.ends_with("page"), "{page}");
        assert!(
            page.contains("Content-Type: text/html") && page.contains("Embedder-Policy: require-corp"),
            "{page}"
        );
        let module = site.get("GET /a%20b/m.wasm");
        assert!(module.contains("Content-Type: application/wasm") && module.ends_with("module"), "{module}");
        let head = site.get("HEAD /");
        assert!(head.starts_with("HTTP/1.1 200") && !head.ends_with("page"), "{head}");
        assert!(site.get("POST /").starts_with("HTTP/1.1 405"), "reading only");
    }

    #[test]
    fn nothing_outside_is_reached() {
        let site = Site::new("outside");
        #[cfg(unix)]
        std::os::unix::fs::symlink(site.0.join("secret"), site.0.join("site/link")).unwrap();
        let attempts = [
            "/../secret",
            "/%2e%2e/secret",
            "/..%2fsecret",
            "/a%20b/../../secret",
            "//etc/passwd",
            "/%2fetc/passwd",
            "/link",
            "/..%5csecret",
            "/%00",
            "/%zz",
            "/%",
            "/absent",
            "/a%20b",
        ];
        for path in attempts {
            let answer = site.get(&format!("GET {path}"));
            assert!(answer.starts_with("HTTP/1.1 404") && !answer.contains("secret"), "{path}: {answer}");
        }
    }
}
