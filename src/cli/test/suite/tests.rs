//! Suites that are read, and those that are refused.

use super::*;
use crate::cli::test::report::Kind;

fn parse(text: &str) -> Result<Suite, String> {
    Suite::parse(Path::new("dir/s.toml"), text, &CacheArgs::default()).map_err(|error| error.to_string())
}

fn ids(text: &str) -> Vec<String> {
    parse(text).unwrap().cases.into_iter().map(|case| case.id).collect()
}

const FULL: &str = r##"
[suite]
name = "full"
goldens = "pictures"
golden-set = "class"
bless = ["llvmpipe-*"]
golden-kib = 200

[defaults]
size = "64x48"
env = "sky.hdr"
samples = 16
thresholds = ["flip.mean <= 0.004",
              "max-abs <= 24 @ 0.05%"]

[class."nvidia-*"]
thresholds = ["flip.mean <= 0.02"]

[[case]]
name = "helmet"
model = "helmet.glb"
orbit = [-30, 75]
override = ["A.metallic=1", "B.metallic=0"]
matrix = { quality = ["draft", "high"], env = ["neutral", "skies/sun set.hdr"] }

[[case]]
name = "white"
kind = "furnace"
model = "white.glb"
within = "0.5%"

[[case]]
name = "truth"
kind = "reference"
model = "helmet.glb"
thresholds = ["ssim >= 0.98"]
skip = { reason = "too slow", until = 2031-02-03 }
"##;

#[test]
fn a_suite_has_its_cases() {
    let suite = parse(FULL).unwrap();
    let ids: Vec<&str> = suite.cases.iter().map(|case| case.id.as_str()).collect();
    assert_eq!(
        ids,
        [
            "helmet/quality=draft,env=neutral",
            "helmet/quality=draft,env=sun_set",
            "helmet/quality=high,env=neutral",
            "helmet/quality=high,env=sun_set",
            "white",
            "truth"
        ]
    );
    let [first, second, .., white, truth] = &suite.cases[..] else { panic!("{ids:?}") };
    assert_eq!(
        first.settings,
        [
            "--env=neutral",
            "--orbit=-30,75",
            "--override=A.metallic=1",
            "--override=B.metallic=0",
            "--quality=draft",
            "--size=64x48"
        ]
    );
    assert_eq!(first.args.subject.model(), Path::new("dir/helmet.glb"));
    assert_eq!(second.args.subject.environment_source(), "dir/skies/sun set.hdr");
    assert_eq!((white.kind, white.within.clone()), (Kind::Furnace, Some((0.005, "dir/s.toml:30".into()))));
    assert_eq!(white.settings, ["--size=64x48"]);
    assert_eq!(truth.skip.as_ref().unwrap().until, (2031, 2, 3));
    assert!(truth.settings.contains(&"--samples=16".to_owned()));
    let names = |class| suite.limits(first, class).len();
    assert_eq!((names("llvmpipe-22.3"), names("nvidia-t4"), suite.limits(truth, "nvidia-t4").len()), (2, 1, 1));
    assert_eq!(suite.golden("a/b", "llvmpipe-22.3"), Path::new("dir/pictures/llvmpipe-22.3/a/b.png"));
    assert!(suite.check_may_bless("llvmpipe-22.3").is_ok());
    assert!(suite.check_may_bless("nvidia-t4").unwrap_err().to_string().contains("llvmpipe-*"));
    assert_eq!(suite.golden_bytes_max, 200 << 10);
}

const ONE: &str = "[[case]]\nname = 'a'\nmodel = 'a.glb'\nthresholds = ['pixels <= 0']\n";

#[test]
fn little_is_needed() {
    let suite = parse(ONE).unwrap();
    assert_eq!((suite.name.as_str(), suite.default_out().as_path()), ("s", Path::new("dir/s.out")));
    assert_eq!(suite.golden("a", "x"), Path::new("dir/s.goldens/any/a.png"));
    assert!(suite.check_may_bless("x").unwrap_err().to_string().contains("bless = [\"x\"]"));
}

#[test]
fn views_and_variants_are_axes_of_a_matrix() {
    let text = format!("{ONE}matrix = {{ orbit = [[30, 75], [60, 75]], variant = ['red', '1'] }}\n");
    let suite = parse(&text).unwrap();
    let names = ["30,75,variant=red", "30,75,variant=1", "60,75,variant=red", "60,75,variant=1"];
    let ids: Vec<&str> = suite.cases.iter().map(|case| case.id.as_str()).collect();
    assert_eq!(ids, names.map(|name| format!("a/orbit={name}")));
    assert_eq!(suite.cases[1].settings, ["--orbit=30,75", "--variant=1"]);
}

#[test]
fn models_vary_too() {
    let text = "[[case]]\nname = 'm'\nthresholds = ['pixels <= 0']\nmatrix = { model = ['x/a.glb', 'b.gltf'] }\n";
    assert_eq!(ids(text), ["m/model=a", "m/model=b"]);
}

#[test]
fn mistakes_are_named_with_their_line() {
    let one = |line: &str| format!("{ONE}{line}\n");
    for (text, expected) in [
        (one("colour = 1"), "dir/s.toml:5: `colour` is no key of [[case]]; there are name, model"),
        (one("output = 'x'"), "dir/s.toml:5: `output` is no key"),
        (one("times = [0, 1]"), "dir/s.toml:5: animations are not played"),
        (one("variants = ['x']"), "dir/s.toml:5: write several variants as matrix"),
        (one("views = [0, 1]"), "dir/s.toml:5: write several views as matrix"),
        ("[defaults]\ntimes = [0]\n".into(), "dir/s.toml:2: animations are not played"),
        (one("light = ['spot:flux=1lm,at=0,0,1']"), "dir/s.toml:5: case a: --light spot:flux=1lm,at=0,0,1: dir="),
        (one("size = '64'"), "dir/s.toml:5: case a: invalid value '64'"),
        (one("orbit = [1, 2]\neye = [0, 0, 1]"), "case a: the argument '--"),
        (one("samples = 4"), "dir/s.toml:5: `samples` is of the reference renderer"),
        (one("kind = 'gold'"), "dir/s.toml:5: `gold` is no kind"),
        (one("kind = 'furnace'"), "dir/s.toml:1: [[case]] is a furnace: it has `within`"),
        (one("within = 0.1"), "dir/s.toml:1: `within` is for furnaces"),
        (one("matrix = { size = [] }"), "dir/s.toml:5: `size` in the matrix is empty"),
        (one("matrix = { sizes = ['1x1'] }"), "dir/s.toml:5: `sizes` in a matrix is neither"),
        (one("msaa = 1\nmatrix = { msaa = [1, 4] }"), "dir/s.toml:6: `msaa` is in the matrix and beside it"),
        (one("skip = { reason = 'x' }"), "dir/s.toml:5: `skip` has no `until`"),
        (one("skip = { reason = ' ', until = 2030-01-01 }"), "dir/s.toml:5: `skip` has an empty reason"),
        (one("skip = { reason = 'x', until = 2030-01-01, who = 'me' }"), "dir/s.toml:5: `who` is no key of `skip`"),
        (one("fov = { a = 1 }"), "dir/s.toml:5: `fov` has to be a string, a number"),
        (format!("{ONE}{ONE}"), "dir/s.toml:5: case a is there twice, first in line 1"),
        (ONE.replace("'a'", "'A'") + ONE, "case a is there twice"),
        (ONE.replace("'a'", "'a/b'") + ONE, "case a is also the folder of other cases"),
        (ONE.replace("pixels <= 0", "pixel <= 0"), "dir/s.toml:4: \"pixel\" is no measurement"),
        (ONE.replace("'pixels <= 0'", ""), "dir/s.toml:4: `thresholds` is empty"),
        (
            "[[case]]\nname = 'a'\nmodel = 'b'\n".into(),
            "dir/s.toml:1: [[case]] has no thresholds, and neither has [defaults]",
        ),
        ("[defaults]\nthresholds = []\n".into(), "dir/s.toml:2: `thresholds` is empty"),
        ("[defaults]\ncolour = 1\n".into(), "dir/s.toml:2: `colour` is no key of `defaults`"),
        ("[suite]\ncolour = 1\n".into(), "dir/s.toml:2: `colour` is no key of `suite`"),
        ("[suits]\n".into(), "dir/s.toml:1: `suits` is no key of a suite; there are suite, defaults, class, case"),
        ("[class.x]\nlimits = 1\n".into(), "dir/s.toml:1: this class has no `thresholds`"),
        ("[suite]\ngolden-set = 'all'\n".into(), "dir/s.toml:2: `all` is no set of goldens"),
        (String::new(), "dir/s.toml:1: the suite has no [[case]]"),
        (ONE.replace("model = 'a.glb'\n", ""), "dir/s.toml:1: [[case]] has no `model`"),
        (ONE.replace("a.glb", "-"), "a model of a suite is a file"),
    ] {
        let error = parse(&text).unwrap_err();
        assert!(error.contains(expected) && !error.contains('\n'), "{text}\n{error}\nand not {expected}");
    }
    for name in ["", "..", "a/../b", "/a", "a//b", "a b", "a\\\\b", "-a", "a:b", "ü", "a."] {
        let error = parse(&ONE.replacen("'a'", &format!("\"{name}\""), 1)).unwrap_err();
        assert!(error.contains("dir/s.toml:2: ") && error.contains("is no name"), "{name}: {error}");
    }
}

#[test]
fn furnaces_have_no_other_light() {
    let furnace = "[[case]]\nname = 'a'\nkind = 'furnace'\nmodel = 'a.glb'\nwithin = 0.005\n";
    assert!(parse(furnace).is_ok());
    for line in ["env = 'neutral'", "light = ['point:flux=1lm,at=0,0,0']", "matrix = { env = ['white'] }"] {
        let error = parse(&format!("{furnace}{line}\n")).unwrap_err();
        assert!(error.starts_with("dir/s.toml:6: a furnace has white surroundings"), "{error}");
    }
    let defaults = format!("[defaults]\nenv = 'black'\nsize = '9x9'\n{furnace}");
    assert_eq!(parse(&defaults).unwrap().cases[0].settings, ["--size=9x9"]);
}
