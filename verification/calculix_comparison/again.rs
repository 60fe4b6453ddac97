//! CalculiX run anew where it is installed.

use super::{RIGID, difference, files, largest, not_understood, oracle};
use crate::case::CaseError;
use crate::check::Check;
use crate::context::CaseContext;

/// CalculiX run now against CalculiX as kept.
pub fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    let version = files::text("kept/version.txt")?.trim();
    let Some(rerun) = files::rerun()? else {
        context.finding(
            "calculix",
            format!("No ccx on the path: compared with the kept output alone (\"{version}\")."),
        );
        return Ok(());
    };
    context.finding(
        "calculix",
        format!(
            "ccx was run anew (\"{}\"); the checks \"run now against kept\" hold it against the kept output (\"{version}\").",
            rerun.version
        ),
    );
    for (name, now) in &rerun.outputs {
        let file = name.strip_prefix("kept/").unwrap_or(name);
        let (stem, end) = file.rsplit_once('.').unwrap_or((file, ""));
        let apart = match end {
            "dat" if stem.ends_with("static") => {
                let parse =
                    |text: &str| oracle::displacements(text).ok_or_else(|| not_understood(name));
                difference(&parse(now)?, &parse(files::text(name)?)?)
            }
            "dat" => {
                let parse =
                    |text: &str| oracle::frequencies(text).ok_or_else(|| not_understood(name));
                let (now, kept) = (parse(now)?, parse(files::text(name)?)?);
                let rigid = if stem.ends_with("free") { RIGID } else { 0 };
                if now.len() != kept.len() {
                    f64::NAN
                } else {
                    largest((rigid..now.len()).map(|i| (now[i] / kept[i] - 1.0).abs()))
                }
            }
            "mas" | "sti" => {
                let dof = |name: &str| name.replace(end, "dof");
                let parse = |text: &str, dof: &str| {
                    oracle::matrix(text, dof).ok_or_else(|| not_understood(name))
                };
                let now = parse(now, rerun.outputs.get(&dof(name)).map_or("", String::as_str))?;
                let kept = parse(files::text(name)?, files::text(&dof(name))?)?;
                if now.shape() != kept.shape() {
                    f64::NAN
                } else {
                    largest((&now - &kept).iter().map(|x| x.abs()))
                        / largest(kept.iter().map(|x| x.abs()))
                }
            }
            _ => continue,
        };
        context.check(
            Check::new(
                &format!("rerun_{}", file.replace('.', "_")),
                &format!("{file}: run now against kept, largest relative difference"),
                "1",
                apart,
            )
            .independent(0.0, "CalculiX as kept")
            .absolute(2e-6, "CalculiX prints seven digits"),
        );
    }
    Ok(())
}
