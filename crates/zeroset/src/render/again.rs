//! Pictures made again from what they say of how they were made: their [`Recipe`], and a scene given beside them.

use super::target::Container;
use crate::args::RenderArgs;
use crate::backend::{Backend, Used};
use crate::console::Console;
use crate::failure::{Exit, Failure};
use crate::file::default_name;
use crate::values::Size;
use std::path::{Path, PathBuf};
use zeroset_language::naming::default_stem;
use zeroset_output::display;
use zeroset_output::format::recipe::{Recipe, RecipeError};
use zeroset_scene::camera::Camera;
use zeroset_scene::film::Plane;
use zeroset_scene::scene::Scene;

/// Most names that are looked for beside a picture.
const NAMES: usize = 8;

/// The command line that makes the same picture again, where it names a picture in place of a scene. What else it says counts instead of
/// what the picture says.
///
/// # Errors
/// The picture does not say how it was made, or there is no scene beside it.
pub(super) fn followed(args: &RenderArgs, console: &Console) -> Result<RenderArgs, Failure> {
    let path = &args.scene.scene;
    let kind = match path.extension() {
        Some(ending) if ending.eq_ignore_ascii_case("png") => "png",
        Some(ending) if ending.eq_ignore_ascii_case("exr") => "exr",
        _ if args.scene_file.is_some() => {
            let message = format!("{} is no picture to make again", path.display());
            let help = "--scene names the scene of a picture: zeroset render picture.png --scene scene.star";
            return Err(Failure::with_help(Exit::Usage, message, help));
        }
        _ => return Ok(args.clone()),
    };
    let recipe = Recipe::of_picture(path).map_err(|error| unknown(path, &error))?;
    let scene = match &args.scene_file {
        Some(scene) => scene.clone(),
        None => beside(path)?,
    };
    let mut out = args.clone();
    if out.output.is_none() {
        let number = if out.frames.is_some() { "-####" } else { "" };
        out.output = Some(default_name(path, &format!("-again{number}.{kind}"))?);
    }
    follow(&mut out, &recipe).map_err(|why| damaged(path, &why))?;
    out.scene.scene = scene;
    let own = env!("CARGO_PKG_VERSION");
    if recipe.zeroset != own {
        console.note(format_args!(
            "{} was made by Zeroset {}, this is {own}: the picture may differ.",
            path.display(),
            display::name(&recipe.zeroset, 40)
        ));
    }
    if recipe.unfinished {
        console.note(format_args!(
            "A time limit ended {} before it was finished: this one will differ.",
            path.display()
        ));
    }
    out.recipe = Some(Box::new(recipe));
    Ok(out)
}

/// Puts what a picture says in all places of the command line that say nothing.
fn follow(args: &mut RenderArgs, recipe: &Recipe) -> Result<(), String> {
    for (name, value) in &recipe.set {
        if !args.scene.set.iter().any(|(other, _)| other == name) {
            args.scene.set.push((name.clone(), value.clone()));
        }
    }
    if !recipe.time.is_finite() {
        return Err("its time is no number of seconds".to_owned());
    }
    args.scene.time.get_or_insert(recipe.time);
    if recipe.size.contains(&0) {
        return Err("it has no pixels".to_owned());
    }
    args.size.get_or_insert(Size(recipe.size));
    let methods = &mut args.methods;
    // rays are stated by --aa too
    if methods.spp.is_none() && methods.aa.is_none() {
        methods.spp = recipe.spp;
    }
    if methods.spp == Some(0) {
        return Err("it has no rays a pixel".to_owned());
    }
    for (option, text) in &recipe.methods {
        methods.choose(option, text)?;
    }
    methods.seed.get_or_insert(recipe.seed);
    if args.noise.is_none() {
        args.noise = recipe.noise;
    }
    if args
        .noise
        .is_some_and(|noise| !(noise.is_finite() && noise > 0.0))
    {
        return Err("its noise is not above 0".to_owned());
    }
    // one of these is asked for: as many as there may be
    let is_exr = matches!(
        args.output.as_deref().map(Container::of),
        Some(Ok(Container::Exr))
    );
    args.cryptomatte |= recipe.cryptomatte && is_exr && args.time_limit.is_none();
    if args.view.is_none() && !args.transparent && !args.denoise {
        let named = |name: &String| {
            let found = Plane::ALL.into_iter().find(|p| p.name() == name);
            found.ok_or_else(|| "it shows no plane of a film".to_owned())
        };
        let view = recipe.view.as_ref().map(named).transpose()?;
        args.view = view.filter(|_| !is_exr);
        args.transparent = recipe.transparent;
        args.denoise = recipe.denoise;
        if args.view.is_some_and(|view| view != Plane::Colour) && (args.transparent || args.denoise)
            || args.transparent && args.denoise
        {
            return Err("it asks for what does not go together".to_owned());
        }
    }
    args.no_legend |= recipe.no_legend;
    if args.bits.is_none() {
        args.bits = match recipe.bits {
            None => None,
            Some(bits @ (8 | 16)) => Some(bits.to_string()),
            Some(bits) => return Err(format!("no PNG has {bits} bits a channel here")),
        };
    }
    if args.backend == Backend::Auto && args.adapter.is_none() && recipe.gpu.is_none() {
        args.backend = Backend::Cpu;
    }
    Ok(())
}

/// The camera of a picture that is made again, where it is not the scene's own and nothing is asked for that moves that one.
pub(super) fn camera(args: &RenderArgs, recipe: &Recipe, scene: &Scene) -> Option<Camera> {
    let is_same = args.frames.is_none()
        && args.scene.time == Some(recipe.time)
        && args.size == Some(Size(recipe.size))
        && (args.scene.set.iter()).all(|(name, value)| recipe.set.get(name) == Some(value));
    Some(recipe.camera).filter(|camera| is_same && camera != scene.camera())
}

/// Says why a picture that is made again may differ.
pub(super) fn say_differences(recipe: &Recipe, files: &str, used: &Used, console: &Console) {
    if recipe.files != files {
        console.note(
            "The scene has changed since the picture was made: what is made again may differ.",
        );
    }
    if recipe.gpu.as_deref() != used.adapter() {
        console.note(format_args!(
            "The picture was rendered by {}, this one by {}: they differ a little.",
            (recipe.gpu.as_deref()).map_or("the CPU".to_owned(), |name| display::name(name, 80)),
            used.adapter().unwrap_or("the CPU")
        ));
    }
}

/// The scene beside a picture: the longest beginning of its name, up to a hyphen, that a scene has.
fn beside(picture: &Path) -> Result<PathBuf, Failure> {
    let stem = picture.file_stem().unwrap_or_default().to_string_lossy();
    let mut names = vec![stem.as_ref()];
    while names.len() < NAMES
        && let Some((shorter, _)) = names.last().and_then(|name| name.rsplit_once('-'))
        && !shorter.is_empty()
    {
        names.push(shorter);
    }
    let files = names.iter().flat_map(|name| {
        ["star", "json"].map(|ending| picture.with_file_name(format!("{name}.{ending}")))
    });
    files.clone().find(|file| file.is_file()).ok_or_else(|| {
        Failure::with_help(
            Exit::Usage,
            format!(
                "{} says how it was made, but there is no {}.star beside it",
                picture.display(),
                default_stem(picture)
            ),
            "name its scene: zeroset render PICTURE --scene SCENE",
        )
    })
}

fn unknown(path: &Path, error: &RecipeError) -> Failure {
    let name = path.display();
    match error {
        RecipeError::Picture(error) => Failure::new(Exit::File, error.to_string()),
        RecipeError::Missing => Failure::with_help(
            Exit::File,
            format!("{name} does not say how it was made"),
            "`zeroset render` writes that into its pictures (from 0.1 on); most programs that change a picture drop it",
        ),
        RecipeError::Format(_) => Failure::with_help(
            Exit::File,
            format!("{name}: {error}"),
            "make it again with the Zeroset that made it, or a later one",
        ),
        RecipeError::Damaged(why) => damaged(path, why),
    }
}

fn damaged(path: &Path, why: &str) -> Failure {
    Failure::with_help(
        Exit::File,
        format!("{}: its recipe is damaged: {why}", path.display()),
        "render the scene itself",
    )
}
