//! Scratch driver.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use carom::case::{Document, read};
use carom::{GridReport, Simulation};
fn main() {
    let mut args = std::env::args().skip(1);
    let path = args.next().unwrap();
    let sets: Vec<String> = args.collect();
    let doc = match Document::open(path.as_ref(), &sets) {
        Ok(d) => d,
        Err(e) => {
            println!("{e}");
            return;
        }
    };
    let case = match read(&doc) {
        Ok(c) => c,
        Err(p) => {
            println!("{}", doc.diagnose_all(&p));
            return;
        }
    };
    if case.dimension == 1 { go::<1>(&case, &doc) } else { go::<2>(&case, &doc) }
}
fn go<const D: usize>(case: &carom::case::Case, doc: &Document)
where
    carom::model::Space: carom::model::Dimension<D>,
{
    let t = std::time::Instant::now();
    let mut sim = match Simulation::<D>::new(case, 1) {
        Ok(s) => s,
        Err(p) => {
            println!("{}", doc.diagnose_all(&p));
            return;
        }
    };
    println!("dofs {} setup {:?}", sim.model.free.len(), t.elapsed());
    let t = std::time::Instant::now();
    let (mut newton, mut rejected) = (0, 0);
    let mut values = Vec::new();
    let (mut min, mut tmin) = (vec![f64::INFINITY; 20], vec![0.0; 20]);
    let mut last_active = 0.0;
    let every = std::env::var("EVERY").ok().and_then(|s| s.parse::<u64>().ok()).unwrap_or(20);
    while !sim.finished() {
        let mut report = GridReport::default();
        let r = sim.advance(&mut report);
        newton += report.newton;
        rejected += report.rejected;
        for e in &report.events {
            if let carom::LogEvent::Rejected { .. } = e {
                println!("  {e:?}");
            }
        }
        if let Err(e) = r {
            println!("STOP {e}");
            break;
        }
        values.clear();
        for p in &sim.model.probes {
            p.values(&sim.model, &sim.state, &mut values);
        }
        for (i, v) in values.iter().enumerate() {
            if *v < min[i] {
                min[i] = *v;
                tmin[i] = sim.state.time;
            }
        }
        let active = sim.state.pairs.iter().flatten().filter(|p| p.active).count();
        if active > 0 {
            last_active = sim.state.time;
        }
        let l = &sim.state.ledger;
        if sim.state.step % every == 0 {
            println!(
                "{:5} t={:.4} newton={} act={} (+{} -{}) F={:?} E={:.6e} diss={:.3e} cw={:.2e} probes {:?}",
                sim.state.step,
                sim.state.time,
                report.newton,
                active,
                report.activations,
                report.releases,
                sim.state.contact_forces,
                l.total(),
                l.dissipation(),
                l.contact_work,
                values
            );
        }
    }
    println!("newton {newton} rejected {rejected} factorisations {} wall {:?}", sim.factorisations(), t.elapsed());
    println!("min {:?} at {:?}; last active {last_active}", &min[..values.len()], &tmin[..values.len()]);
}
