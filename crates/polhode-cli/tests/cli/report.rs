//! The page of results: whole, alone, and right at two widths in a real browser where one is installed.

use std::fs;
use std::process::Command;

use crate::harness::{Scratch, output, refused};

#[test]
fn the_page_holds_every_result_and_needs_nothing_else() {
    let scratch = Scratch::new("report-page");
    let out = scratch.0.join("results");
    let page = out.join("results.html"); // in a folder that is not there yet
    let line = format!(
        "experiment run order separatrix --scale smoke --out {} --report {}",
        out.display(),
        page.display()
    );
    output(&line);
    let html = fs::read_to_string(&page).unwrap();
    for part in [
        "<section id=\"order\">",
        "<section id=\"separatrix\">",
        "id=\"polhode-curves\"",
        "id=\"herpolhode-curves\"",
    ] {
        assert_eq!(html.matches(part).count(), 1, "{part}");
    }
    // every row of a table that is shown is there
    let csv = fs::read_to_string(out.join("smoke/order/orders.csv")).unwrap();
    for name in csv.lines().skip(1).map(|row| row.split(',').next().unwrap()) {
        assert!(html.contains(&format!("<td>{name}</td>")), "{name}");
    }
    // figures name the language of SVG by an address; nothing is fetched
    let fetched = html.replace("http://www.w3.org/2000/svg", "");
    for address in ["http:", "https:", " src=", "<link", "@import", "url("] {
        assert!(!fetched.contains(address), "{address}");
    }
    assert!(!html.contains("NaN"));

    let Some(browser) = ["chromium", "chromium-browser", "google-chrome"].into_iter().find(|name| {
        Command::new(name).arg("--version").output().is_ok_and(|answer| answer.status.success())
    }) else {
        eprintln!("no Chromium is installed: the page was not opened");
        return;
    };
    for width in [1280, 390] {
        for dark in [false, true] {
            let mut command = Command::new(browser);
            command.args([
                "--headless",
                "--no-sandbox",
                "--disable-gpu",
                "--disable-quic",
                "--disable-sync",
                "--no-first-run",
            ]);
            command.args([
                "--disable-background-networking",
                "--disable-component-update",
                "--hide-scrollbars",
                "--dump-dom",
            ]);
            if dark {
                command.arg("--force-dark-mode");
            }
            command.arg(format!("--window-size={width},900"));
            command.arg(format!(
                "--user-data-dir={}",
                scratch.0.join(format!("profile-{width}-{dark}")).display()
            ));
            command.arg(format!("file://{}", page.display()));
            let dom = String::from_utf8(command.output().unwrap().stdout).unwrap();
            // the script ran to its end, drew both canvases, and nothing is wider than the window
            assert!(
                dom.contains("data-overflow=\"0\"") || dom.contains("data-overflow=\"-"),
                "{width}: {}",
                &dom[..dom.len().min(200)]
            );
            assert_eq!(dom.matches("data-drawn=\"").count(), 2, "{width}");
        }
    }
}

#[test]
fn a_page_that_cannot_be_written_is_refused_before_the_work() {
    refused("experiment run all --report results.pdf", &["--report", "'results.pdf'", ".html"]);
    refused("experiment run --report /no/such/folder/results.html", &["--report", "/no/such/folder"]);
}
