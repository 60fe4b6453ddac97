//! `make-fmu SCENE OUT.fmu`: packs the library and a scene.

use bearing_dynamics::scene::Document;
use bearing_fmu::model::Model;
use bearing_fmu::variables::{INPUTS, Variable, inputs, outputs};
use sha2::{Digest, Sha256};
use std::env::consts::{ARCH, DLL_PREFIX, DLL_SUFFIX, OS};
use std::error::Error;
use std::fs::File;
use std::io::Write;
use std::path::{Component, Path};
use std::process::ExitCode;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

const LIBRARY: &str = "bearing_fmu";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [scene, out] = &arguments[..] else {
        eprintln!("usage: make-fmu SCENE OUT.fmu");
        return ExitCode::from(2);
    };
    match make(Path::new(scene), Path::new(out)) {
        Ok(()) => {
            println!("wrote {out}");
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(2)
        }
    }
}

fn make(scene: &Path, out: &Path) -> Result<(), Box<dyn Error>> {
    let mut model = Model::read(scene)?;
    // Fails here rather than in a simulation: no equilibrium, no step.
    model.begin(0.0);
    model.end_initialization()?;
    let document = Document::read_file(scene)?;
    let library =
        std::env::current_exe()?.with_file_name(format!("{DLL_PREFIX}{LIBRARY}{DLL_SUFFIX}"));
    let binary = std::fs::read(&library)
        .map_err(|error| format!("cannot read {}: {error}", library.display()))?;
    let kind = scene.extension().and_then(|extension| extension.to_str()).unwrap_or("toml");
    let title = scene.file_stem().unwrap_or_default().to_string_lossy();
    let os = if OS == "macos" { "darwin" } else { OS };
    let mut files = vec![
        (
            "modelDescription.xml".to_string(),
            description(&title, &model, document.text()).into_bytes(),
        ),
        (format!("binaries/{ARCH}-{os}/{LIBRARY}{DLL_SUFFIX}"), binary),
        (format!("resources/scene.{kind}"), document.text().as_bytes().to_vec()),
    ];
    for (name, text) in document.bases() {
        // A base is read beside the scene that is packed.
        let beside = scene.with_file_name(&name);
        if !std::fs::read_to_string(&beside).is_ok_and(|found| found == text)
            || !Path::new(&name).components().all(|part| matches!(part, Component::Normal(_)))
        {
            return Err(format!(
                "{name} is outside the folder of the scene; put it next to the scene"
            )
            .into());
        }
        files.push((format!("resources/{name}"), text.as_bytes().to_vec()));
    }
    let mut archive = File::create(out)
        .map(ZipWriter::new)
        .map_err(|error| format!("cannot write {}: {error}", out.display()))?;
    for (name, bytes) in files {
        archive.start_file(name, SimpleFileOptions::default())?;
        archive.write_all(&bytes)?;
    }
    archive.finish()?;
    Ok(())
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}

fn description(name: &str, model: &Model, scene: &str) -> String {
    let token: String = Sha256::digest(scene).iter().map(|byte| format!("{byte:02x}")).collect();
    let variable = |reference: usize, Variable { name, unit }: &Variable, rest: &str| {
        format!(
            "    <Float64 name=\"{name}\" valueReference=\"{reference}\" {rest} unit=\"{unit}\"/>\n"
        )
    };
    let mut variables = String::from(
        "    <Float64 name=\"time\" valueReference=\"0\" causality=\"independent\" variability=\"continuous\" unit=\"s\"/>\n",
    );
    for (i, input) in inputs().iter().enumerate() {
        let start = model.inputs[i];
        variables += &variable(i + 1, input, &format!("causality=\"input\" start=\"{start:?}\""));
    }
    let (mut of_outputs, mut unknowns) = (String::new(), String::new());
    for (i, output) in outputs().iter().enumerate() {
        let reference = INPUTS + 1 + i;
        variables += &variable(reference, output, "causality=\"output\" initial=\"calculated\"");
        of_outputs += &format!("    <Output valueReference=\"{reference}\"/>\n");
        unknowns += &format!("    <InitialUnknown valueReference=\"{reference}\"/>\n");
    }
    let (name, version) = (escaped(name), env!("CARGO_PKG_VERSION"));
    format!(
        r#"<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="3.0" modelName="{name}" instantiationToken="{token}" variableNamingConvention="structured" generationTool="bearing-dynamics {version}">
  <CoSimulation modelIdentifier="{LIBRARY}" canHandleVariableCommunicationStepSize="true" canGetAndSetFMUState="true" canSerializeFMUState="true"/>
  <UnitDefinitions>
    <Unit name="s"><BaseUnit s="1"/></Unit>
    <Unit name="m"><BaseUnit m="1"/></Unit>
    <Unit name="m/s"><BaseUnit m="1" s="-1"/></Unit>
    <Unit name="rad"><BaseUnit rad="1"/></Unit>
    <Unit name="rad/s"><BaseUnit rad="1" s="-1"/></Unit>
    <Unit name="N"><BaseUnit kg="1" m="1" s="-2"/></Unit>
    <Unit name="N.m"><BaseUnit kg="1" m="2" s="-2"/></Unit>
  </UnitDefinitions>
  <LogCategories>
    <Category name="logStatusError"/>
  </LogCategories>
  <DefaultExperiment startTime="0" stopTime="{end}" stepSize="{step}"/>
  <ModelVariables>
{variables}  </ModelVariables>
  <ModelStructure>
{of_outputs}{unknowns}  </ModelStructure>
</fmiModelDescription>
"#,
        end = model.experiment[0],
        step = model.experiment[1],
    )
}
