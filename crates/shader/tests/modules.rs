//! Every shader module is valid, whatever the methods, and reads what the CPU writes. No GPU is needed.

use naga::front::wgsl;
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use zeroset_catalogue::bounds::Aabb;
use zeroset_field::field::Field;
use zeroset_field::sampled::Sampled;
use zeroset_language::load::{Language, Options, load, load_text};
use zeroset_number::Grid;
use zeroset_scene::material::{Image, Pattern};
use zeroset_scene::scene::{Scene, SceneParts};
use zeroset_scene::settings::{
    Antialias, Filter, Integrator, March, Normals, Occlusion, Shading, Shadow, Tone,
};
use zeroset_shader::entry::{Binding, ENTRIES};
use zeroset_shader::export::ExportError;
use zeroset_shader::layout::{
    self, Frame, Light, LightSum, Material, Occluder, Sample, Shared, SurfaceSum, Tile,
};
use zeroset_shader::{FieldForm, Shaders, export};

fn validate(source: &str, what: &str) -> (naga::Module, ModuleInfo) {
    let module =
        wgsl::parse_str(source).unwrap_or_else(|e| panic!("{what}: {}", e.emit_to_string(source)));
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .unwrap_or_else(|e| panic!("{what}: {}", e.emit_to_string(source)));
    (module, info)
}

fn check(scene: &Scene, form: FieldForm, what: &str) -> String {
    let job = Shaders::new(form)
        .prepare(scene)
        .unwrap_or_else(|e| panic!("{what}: {e}"));
    validate(&job.source, what);
    job.source.to_string()
}

fn scene(text: &str) -> Scene {
    load_text(
        "test.star",
        text,
        Language::Starlark,
        None,
        &Options::default(),
    )
    .unwrap_or_else(|e| panic!("{}", e.report))
    .scene
}

/// Every scene that comes along.
fn scenes() -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).expect("the scenes").flatten() {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "star") {
                found.push(path);
            }
        }
    }
    found.sort();
    assert!(found.len() > 20);
    found
}

#[test]
fn every_scene_has_a_valid_shader() {
    for path in scenes() {
        let Ok(loaded) = load(&path, &Options::default()) else {
            // a part of other scenes, which shows nothing itself
            continue;
        };
        for form in [FieldForm::Compiled, FieldForm::Interpreted] {
            check(&loaded.scene, form, &format!("{} {form:?}", path.display()));
        }
    }
}

const PATTERNS: &str = r#"
show(sphere(1), material(color = "red"))
show(box(1).move(x = 2), material(color = checker("white", "black", size = 0.2)))
show(box(1).move(x = 4), material(color = stripes("white", "black", direction = "z", size = 0.2)))
show(box(1).move(x = 6), material(color = noise("white", "black", size = 0.2)))
show(box(1).move(x = 8), material(color = gradient("white", "black", start = (0, 0, 0), end = (0, 1, 0))))
show(mandelbulb().move(x = 12), material(color = orbit(center = "red", x = "white", y = "black", z = "blue")))
"#;

#[test]
fn every_method_has_a_valid_shader() {
    let base = scene("show(sphere(1))");
    let (normals, shadings, shadows) = (Normals::ALL, Shading::ALL, Shadow::ALL);
    let ways = Integrator::ALL;
    let mut texts = BTreeMap::new();
    let mut count = 0;
    for (i, (march, occlusion)) in (March::ALL
        .iter()
        .flat_map(|m| Occlusion::ALL.iter().map(move |o| (m, o))))
    .enumerate()
    {
        let mut scene = base.clone();
        scene
            .edit(|s| {
                s.settings.march = *march;
                s.settings.occlusion = *occlusion;
                s.settings.normals = normals[i % normals.len()];
                s.settings.shading = shadings[i % shadings.len()];
                s.settings.integrator = ways[i % ways.len()];
                for light in &mut s.lights {
                    light.shadow = shadows[i % shadows.len()];
                }
            })
            .expect("a scene");
        texts.insert(
            check(
                &scene,
                FieldForm::Compiled,
                &format!("{:?}", scene.settings()),
            ),
            i,
        );
        count += 1;
    }
    assert_eq!(texts.len(), count, "two methods have the same shader");
}

/// The patterns, with an image of this size.
fn patterns([width, height]: [u32; 2]) -> Scene {
    let mut scene = scene(PATTERNS);
    scene
        .edit(|s| {
            s.materials[0].pattern = Pattern::Triplanar {
                image: Arc::new(Image {
                    path: "one.png".into(),
                    width,
                    height,
                    pixels: vec![glam::Vec3::ONE; (width * height) as usize],
                }),
                size: 1.0,
                sharpness: 4.0,
            }
        })
        .expect("a scene");
    scene
}

/// A scene whose field is a grid of so many nodes along each axis.
fn sampled(side: u32) -> Scene {
    let values = (0..side.pow(3)).map(|i| (i % side) as f32 - 1.0).collect();
    let grid = Grid::new([side; 3], values).expect("a grid");
    let sampled = Sampled::new(Arc::new(grid), Aabb::centred([1.0; 3])).expect("a box");
    let mut scene = scene("show(sphere(1))");
    scene
        .edit(|s| s.objects[0].field = Field::sampled(Arc::new(sampled)))
        .expect("a scene");
    scene
}

#[test]
fn a_field_of_samples_has_a_valid_shader() {
    for form in [FieldForm::Compiled, FieldForm::Interpreted] {
        let text = check(&sampled(4), form, "samples");
        assert!(text.contains("grid_sample("), "{form:?}");
    }
    // another grid is another texture, not another text
    let mut shaders = Shaders::default();
    let mut text = |side| shaders.prepare(&sampled(side)).expect("a job").source;
    assert_eq!(text(4), text(9));
    let sphere = check(&scene("show(sphere(1))"), FieldForm::Compiled, "sphere");
    assert!(!sphere.contains("grid_sample"));
}

#[test]
fn every_pattern_has_a_valid_shader() {
    let scene = patterns([1, 1]);
    let text = check(&scene, FieldForm::Compiled, "patterns");
    for kind in [
        "checker",
        "stripes",
        "noise",
        "gradient",
        "triplanar",
        "orbit",
    ] {
        // as a function, and where it is called
        let named = text.matches(&format!("pattern_{kind}(")).count();
        assert!(named > 1, "{kind}");
    }
}

#[test]
fn numbers_leave_the_shader_as_it_is() {
    let mut shaders = Shaders::new(FieldForm::Auto);
    let mut of = |text: &str, edit: fn(&mut SceneParts)| {
        let mut scene = scene(text);
        scene.edit(edit).expect("a scene");
        shaders.prepare(&scene).expect("a job").source
    };
    let first = of("show(sphere(1) | box((1, 2, 3)).move(x = 1))", |_| {});
    let other = of("show(sphere(2) | box((3, 2, 1)).move(y = 2))", |s| {
        s.settings.size = [64, 32];
        s.settings.march = March::Auto { beta: 0.5 };
        s.settings.prepass = false;
        s.settings.antialias = Antialias::Supersample {
            samples: 9,
            filter: Filter::Tent,
        };
    });
    assert_eq!(first, other);
    assert_ne!(
        first,
        of("show(sphere(1) | torus(radius = 1, tube = 0.2))", |_| {})
    );
}

/// The layout that naga gives a struct of the shader is that of the CPU's.
fn same_layout<T: Shared>(module: &naga::Module) {
    let found = module.types.iter().find_map(|(_, ty)| match &ty.inner {
        naga::TypeInner::Struct { members, span } if ty.name.as_deref() == Some(T::NAME) => {
            Some((members, *span))
        }
        _ => None,
    });
    let (members, span) = found.unwrap_or_else(|| panic!("no struct {}", T::NAME));
    assert_eq!(members.len(), T::MEMBERS.len());
    for (member, ours) in members.iter().zip(T::MEMBERS) {
        assert_eq!(member.name.as_deref(), Some(ours.name));
        assert_eq!(
            member.offset as usize,
            ours.offset,
            "{}.{}",
            T::NAME,
            ours.name
        );
    }
    assert_eq!(span as usize, size_of::<T>(), "size of {}", T::NAME);
}

#[test]
fn layouts_are_the_shaders() {
    let job = Shaders::default()
        .prepare(&scene("show(sphere(1))"))
        .expect("a job");
    let (module, _) = validate(&job.source, "sphere");
    same_layout::<Frame>(&module);
    same_layout::<Tile>(&module);
    same_layout::<Light>(&module);
    same_layout::<Occluder>(&module);
    same_layout::<Material>(&module);
    same_layout::<Sample>(&module);
    same_layout::<LightSum>(&module);
    same_layout::<SurfaceSum>(&module);
    let job = Shaders::default().prepare(&sampled(2)).expect("a job");
    let (module, _) = validate(&job.source, "samples");
    same_layout::<layout::Grid>(&module);
}

#[test]
fn entry_points_use_the_buffers_and_textures_that_they_state() {
    for scene in [scene("show(sphere(1))"), patterns([3, 2]), sampled(3)] {
        uses_what_it_states(&scene);
    }
}

fn uses_what_it_states(scene: &Scene) {
    for form in [FieldForm::Compiled, FieldForm::Interpreted] {
        let mut shaders = Shaders::new(form);
        let job = shaders.prepare(scene).expect("a job");
        let (module, info) = validate(&job.source, scene.name());
        check_entries(&module, &info);
        let turned = shaders.in_turns(&job).expect("a job in turns");
        let (module, info) = validate(&turned.source, "in turns");
        check_entries(&module, &info);
    }
}

fn check_entries(module: &naga::Module, info: &ModuleInfo) {
    assert_eq!(module.entry_points.len(), ENTRIES.len());
    for (k, point) in module.entry_points.iter().enumerate() {
        let entry = ENTRIES
            .iter()
            .find(|e| e.name == point.name)
            .expect("a known entry point");
        let uses = info.get_entry_point(k);
        for (handle, variable) in module.global_variables.iter() {
            if let Some(binding) = &variable.binding
                && !uses[handle].is_empty()
            {
                let which = Binding::ALL[binding.binding as usize];
                assert_eq!(which as u32, binding.binding);
                let list = naga::TypeInner::Image {
                    dim: naga::ImageDimension::D2,
                    arrayed: true,
                    class: naga::ImageClass::Sampled {
                        kind: naga::ScalarKind::Float,
                        multi: false,
                    },
                };
                let inner = &module.types[variable.ty].inner;
                assert_eq!(which.is_texture(), *inner == list, "{which:?}");
                assert!(
                    entry.bindings.contains(&which),
                    "{} uses {which:?}",
                    entry.name
                );
            }
        }
        let storage = entry
            .bindings
            .iter()
            .filter(|b| !b.is_texture() && !matches!(b, Binding::Numbers | Binding::Rows))
            .count();
        assert!(storage <= 8, "{} has {storage} storage buffers", entry.name);
    }
}

/// The shader that traces rays in turns, for every scene: it asks the field in one place.
#[test]
fn every_scene_can_be_traced_in_turns() {
    for path in scenes() {
        let Ok(loaded) = load(&path, &Options::default()) else {
            continue;
        };
        for form in [FieldForm::Compiled, FieldForm::Interpreted] {
            let mut shaders = Shaders::new(form);
            let job = shaders.prepare(&loaded.scene).expect("a job");
            let turned = shaders.in_turns(&job).expect("a job in turns");
            assert!(turned.in_turns && !turned.prepass());
            assert!(shaders.in_turns(&turned).is_none());
            validate(&turned.source, &format!("{} {form:?}", path.display()));
            for name in ["field(", "field_gradient(", "field_marks("] {
                let (asked, told) = (format!("asked_{name}"), format!("fn {name}p: vec3f)"));
                // declared and called once
                assert_eq!(turned.source.matches(&asked).count(), 2, "{name}");
                assert_eq!(turned.source.matches(&told).count(), 1, "{name}");
            }
            // a word for every register that the program has
            assert_eq!(turned.registers > 0, form == FieldForm::Interpreted);
        }
    }
}

#[test]
fn large_scenes_are_exported_or_refused() {
    let parts = |n: usize| {
        format!(
            "for i in range({n}):\n    show(sphere(0.1).move((i % 50, i // 50, 0)), material(color = hsv(i % 360, 0.5, 0.5)))"
        )
    };
    let chain = |n: usize| {
        format!(
            "s = sphere()\nfor i in range({n}):\n    s = s.round(0.001).twist(1).move(y = 0.001)\nshow(s)"
        )
    };
    for (text, fits) in [
        (parts(200), true),
        (parts(5000), false),
        (chain(160), true),
        (chain(168), true),
    ] {
        let scene = scene(&text);
        match (export::wgsl(&scene), export::glsl(&scene)) {
            (Ok(wgsl), Ok(_)) if fits => {
                validate(&wgsl, &text);
            }
            (Err(ExportError::Large { count, .. }), Err(ExportError::Large { .. })) if !fits => {
                assert!(count > 4000, "{count}");
            }
            (wgsl, glsl) => panic!("{text}: {:?}, {:?}", wgsl.err(), glsl.err()),
        }
        for form in [FieldForm::Auto, FieldForm::Interpreted] {
            let mut shaders = Shaders::new(form);
            let job = shaders.prepare(&scene).expect("a job");
            validate(&job.source, &text);
            validate(&shaders.in_turns(&job).expect("a job").source, &text);
        }
    }
}

/// A file has no textures: the pixels of its images stand in it, as far as a compiler takes so many.
#[test]
fn every_way_of_light_is_exported() {
    let text = "show(sphere(1), material(color = \"white\", transmission = 1))\nshow(plane().move(y = -1))\nfog(glow = 1)\nsky(sun = 3)";
    for (integrator, tone) in Integrator::ALL.iter().zip(Tone::ALL) {
        let mut scene = scene(text);
        scene
            .edit(|s| (s.settings.integrator, s.settings.tone) = (*integrator, tone))
            .expect("a scene");
        let text = export::wgsl(&scene).unwrap_or_else(|e| panic!("{integrator:?}: {e}"));
        validate(&text, &format!("{integrator:?}"));
        export::glsl(&scene).unwrap_or_else(|e| panic!("{integrator:?}: {e}"));
    }
}

#[test]
fn images_are_exported_or_refused() {
    let scene = patterns([80, 50]);
    let text = export::wgsl(&scene).expect("4000 pixels");
    validate(&text, "an image in a file");
    assert!(text.contains("images: array<vec3f, 4000>") && !text.contains("textureLoad"));
    assert!(export::glsl(&scene).is_ok());
    let error = export::wgsl(&patterns([81, 50])).expect_err("4050 pixels");
    assert!(
        error.to_string().contains("4050 pixels of images"),
        "{error}"
    );
}

#[test]
fn grids_are_exported_or_refused() {
    let text = export::wgsl(&sampled(15)).expect("3375 samples");
    validate(&text, "a grid in a file");
    assert!(!text.contains("textureLoad"));
    assert!(export::glsl(&sampled(15)).is_ok());
    let error = export::wgsl(&sampled(16)).expect_err("4096 samples");
    assert!(
        error.to_string().contains("4096 samples of grids"),
        "{error}"
    );
}

#[test]
fn exported_files_are_valid() {
    for path in scenes() {
        let Ok(loaded) = load(&path, &Options::default()) else {
            continue;
        };
        let what = path.display().to_string();
        let text = match export::wgsl(&loaded.scene) {
            // a mesh has more samples than a file holds, and is refused for that
            Err(e) if e.to_string().contains("samples of grids") => continue,
            // and so is light from all around, by its image
            Err(e) if loaded.scene.environment().is_some() => {
                assert!(e.to_string().contains("pixels of images"), "{what}: {e}");
                continue;
            }
            text => text.unwrap_or_else(|e| panic!("{what}: {e}")),
        };
        validate(&text, &what);
        let text = export::glsl(&loaded.scene).unwrap_or_else(|e| panic!("{what}: {e}"));
        // what Shadertoy puts around a file
        let around = format!(
            "#version 450\nconst vec3 iResolution = vec3(64.0, 48.0, 1.0);\nconst vec4 iMouse = vec4(1.0);\nconst float iTime = 0.5;\nlayout(location = 0) out vec4 colour_out;\n{text}\n\
             void main() {{ mainImage(colour_out, gl_FragCoord.xy); }}\n"
        );
        let options = naga::front::glsl::Options::from(naga::ShaderStage::Fragment);
        naga::front::glsl::Frontend::default()
            .parse(&options, &around)
            .unwrap_or_else(|e| panic!("{what}: {}", e.emit_to_string(&around)));
    }
}
