//! What a command does to the folders that it reads from and writes to.

use std::fs;

use galpix_sim::picture::Picture;
use serde_json::Value;

use crate::{done, entries, folder, galpix, json, marbles, output, refused, text};

fn copy(from: &std::path::Path, to: &std::path::Path) {
    fs::create_dir_all(to).unwrap();
    for name in entries(from) {
        let (from, to) = (from.join(&name), to.join(&name));
        if from.is_dir() { copy(&from, &to) } else { fs::copy(&from, &to).map(drop).unwrap() }
    }
}

#[test]
fn frames_never_replace_what_they_are_made_of() {
    let folder = folder();
    let capture = folder.path().join("mine");
    copy(&marbles(), &capture);
    let frames = capture.join("frames");
    let before: Vec<Vec<u8>> = entries(&frames).iter().map(|name| fs::read(frames.join(name)).unwrap()).collect();
    refused(folder.path(), &["run", "mine", "--out", "mine/frames"], &["0000.png", "is read from mine", "--out"]);
    let after: Vec<Vec<u8>> = entries(&frames).iter().map(|name| fs::read(frames.join(name)).unwrap()).collect();
    assert!(before == after, "an input was changed");
    // Pictures of somebody else are not replaced either, and those of galpix are, unless they are read.
    fs::create_dir(folder.path().join("theirs")).unwrap();
    Picture::filled(2, 2, [1; 3]).write_png(&folder.path().join("theirs/0001.png")).unwrap();
    refused(folder.path(), &["run", "still", "--frames", "2", "--out", "theirs"], &["0001.png", "did not write it"]);
    done(folder.path(), &["run", "mine", "--frames", "2", "--out", "again"]);
    done(folder.path(), &["run", "mine", "--frames", "2", "--out", "again"]);
    fs::copy(folder.path().join("again/0001.png"), frames.join("0001.png")).unwrap();
    refused(folder.path(), &["run", "mine", "--out", "mine/frames"], &["is read from"]);
    fs::rename(capture.join("capture.toml"), capture.join("error.csv")).unwrap();
    let error = ["error", "mine/error.csv", "--quick", "--lanes=still", "--rungs=hold", "--frames=2", "--out", "mine"];
    refused(folder.path(), &error, &["error.csv", "is read from"]);
}

#[test]
fn a_shorter_run_leaves_no_frames_of_a_longer_one_and_says_so() {
    let folder = folder();
    done(folder.path(), &["run", "still", "--frames", "5"]);
    let output = output(folder.path(), &["run", "still", "--frames", "2", "--json"]);
    let said = text(&output.stderr);
    assert!(
        said.contains("3 frames of an earlier, longer run removed") && said.contains("0003.png to 0005.png"),
        "{said}"
    );
    assert!(said.contains("report.html of an earlier run removed"), "{said}");
    let left = entries(&folder.path().join("galpix-out/still"));
    assert_eq!(left, ["0000.png", "0001.png", "0002.png"].map(String::from).into());
}

#[test]
fn fills_leave_no_pictures_of_an_earlier_run() {
    let folder = folder();
    let run = |frames: &str, fills: &str| {
        output(folder.path(), &["fills", "crossing", "--frames", frames, "--fills", fills, "--out", "there"])
    };
    run("3", "none,hold");
    fs::write(folder.path().join("there/crossing/0003/mine.txt"), "").unwrap();
    let said = run("2", "hold");
    assert!(text(&said.stderr).contains("18 pictures of an earlier run removed"), "{}", text(&said.stderr));
    let of_frame = ["hold.png", "mask.png", "mask_all.png", "truth.png", "warped.png"].map(String::from);
    assert_eq!(entries(&folder.path().join("there/crossing/0002")), of_frame.into());
    assert_eq!(entries(&folder.path().join("there/crossing/0003")), ["mine.txt".to_owned()].into());
}

#[test]
fn captures_of_one_name_have_folders_of_their_own() {
    let folder = folder();
    for name in ["first", "second"] {
        copy(&marbles(), &folder.path().join(name));
        done(folder.path(), &["run", name, "--frames", "1"]);
    }
    done(folder.path(), &["run", "first", "--frames", "1"]);
    assert_eq!(entries(&folder.path().join("galpix-out")), ["marbles", "marbles-2"].map(String::from).into());
    refused(folder.path(), &["fills", "first", "second"], &["two sources are called `marbles`", "name"]);
}

/// Frame 1 is the same picture, and has the same figures, however many frames follow it.
#[test]
fn the_frames_asked_for_do_not_change_those_before() {
    let folder = folder();
    let marbles = marbles().display().to_string();
    for source in ["pan", &marbles] {
        let first = |frames: &str, more: &[&str]| -> (Value, Value, Vec<u8>) {
            let arguments = [&["run", source, "--frames", frames, "--out", "there", "--json"][..], more].concat();
            let report = json(folder.path(), &arguments);
            let picture = fs::read(folder.path().join("there/0001.png")).unwrap();
            (report["budget"].clone(), report["frames"][0]["truth"].clone(), picture)
        };
        let (one, all) = (first("1", &[]), first("16", &[]));
        assert_eq!((&one.0, &one.1), (&all.0, &all.1), "{source}");
        assert!(one.2 == all.2 && one == first("40", &[]), "{source}");
        assert_ne!(one.0["position_frac_bits"], first("1", &["--prop", "2"]).0["position_frac_bits"], "{source}");
    }
    let text = done(folder.path(), &["run", "pan", "--frames", "40"]);
    assert!(text.contains("frames 33 to 40 are beyond tau_prop") && text.contains("--prop 64"), "{text}");
}

/// Interrupted at any moment, a run leaves whole frames and nothing else; what a killed one leaves, the next removes.
#[cfg(target_os = "linux")]
#[test]
fn an_interrupted_run_leaves_whole_files_and_nothing_else() {
    use std::process::{Command, Stdio};
    let folder = folder();
    let out = folder.path().join("galpix-out/disc");
    for signal in ["-INT", "-TERM"] {
        let mut child = galpix(folder.path(), &["run", "disc", "--frames", "2000"])
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        while !out.join("0002.png").exists() {
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
        assert!(Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap().success());
        assert_eq!(child.wait().unwrap().code(), Some(130), "{signal}");
        assert!(entries(&out).iter().all(|name| name.ends_with(".png")), "{:?}", entries(&out));
        fs::remove_dir_all(&out).unwrap();
    }
    fs::create_dir_all(&out).unwrap();
    fs::write(out.join(".galpix.4194305.abc.part"), "").unwrap();
    done(folder.path(), &["run", "disc", "--frames", "1", "--json"]);
    assert_eq!(entries(&out), ["0000.png", "0001.png"].map(String::from).into());
}

#[test]
fn what_does_nothing_is_refused() {
    let folder = folder();
    for (arguments, words) in [
        ("run still --fill extend --fovea 9", ["--fovea", "extend"].as_slice()),
        ("run still --fill hold --gamma 1", &["--gamma", "hold"]),
        ("run still --separation 0.1", &["--separation", "--hidden second"]),
        ("run still --hidden ddoc --separation 0.1", &["--separation", "--hidden second"]),
        ("run still --uncut", &["--uncut", "--hidden"]),
        ("run still --reach 2 --fill hold", &["--reach", "hold"]),
        ("run still --edge-threshold 0.1 --fill debris", &["--edge-threshold", "debris"]),
        ("run still --acceleration off", &["--acceleration", "captures"]),
        ("plan still --max-error 1 --acceleration off", &["--acceleration", "captures"]),
        ("error still --fovea 9", &["--fovea", "hold"]),
        ("error still --acceleration clamp", &["--acceleration", "captures"]),
        ("fills still --fills none,hold --gamma 1", &["--gamma", "none, hold"]),
        ("layers still --acceleration smooth", &["--acceleration", "captures"]),
        ("budget --max-error 1 --position-frac 4", &["--position-frac", "--max-error"]),
        ("budget --layout velocity565 --shave-z velocity-int=1", &["--shave-z", "velocity565"]),
        ("budget --layout velocity565 --shave acceleration-int=1", &["shave fewer"]),
        ("send still --to file:stream --panel oled --every 4", &["--every", "--updates"]),
    ] {
        refused(folder.path(), &arguments.split(' ').collect::<Vec<_>>(), words);
    }
    assert!(entries(folder.path()).is_empty(), "what is refused leaves nothing behind");
}
