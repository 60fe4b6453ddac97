//! CalculiX run anew where it is installed.

use super::{RIGID, difference, files, largest, not_understood, oracle};
use crate::case::CaseError;
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
            "ccx was run anew (\"{}\"): its output is the kept one (\"{version}\") to the seven digits it prints; the case fails otherwise.",
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
        // Another program against itself is no check of ours; but kept output that it does not give is
        // no reference. Written so that NaN fails.
        let as_kept = apart <= 2e-6;
        if !as_kept {
            return Err(CaseError::message(format!(
                "{file}: CalculiX now and as kept differ by {apart:.1e}"
            )));
        }
    }
    Ok(())
}
