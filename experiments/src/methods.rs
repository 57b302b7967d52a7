//! Tables of the catalogue of methods and of schemes.

use polhode::body::Problem;
use polhode::method::schemes::{self, Pairs, Part, Stages};
use polhode::method::{
    Claimed, Claims, Dissipating, ExactFlow, Kicks, LinearlyImplicitEuler, Splitting, catalogue, listing,
};
use polhode_pages::table::{Cell, Column, Table, row};

/// One row a method of the catalogue, from its claims for free motion; the closed form first.
pub fn table() -> Table {
    let mut table = Table::new(
        "methods",
        "What each method claims of free motion; the order of kick-drift, which is exact there, is that of motion in a potential. Every claim is tested.",
        vec![
            Column::new("name", "", "name on the command line"),
            Column::new("order", "", "order of convergence"),
            Column::new("energy", "", "exact, bounded or drifts"),
            Column::new("momentum", "", "whether |m| is kept").heading("|m|").latex("$|m|$"),
            Column::new("momentum_vector", "", "whether L in space is kept").heading("L").latex("$L$"),
            Column::new("norm", "", "whether |q| = 1 is kept").heading("|q|").latex("$|q|$"),
            Column::new("symmetric", "", "whether a step back undoes a step"),
            Column::new("poisson", "", "whether the Lie-Poisson bracket is kept").heading("Poisson"),
            Column::new("symplectic", "", "whether the symplectic form of attitude and momentum is kept"),
            Column::new("cost", "", "work per step"),
            Column::new("source", "", "where it comes from"),
            Column::new("formula", "", "one step of size h, from (m, q) to (m', q')").hidden(),
            Column::new("file", "", "where it is written, from the root of the sources").hidden(),
        ],
    );
    // the closed form is the free flow of kick-drift from the start on, whatever the time
    if let Some(claims) = Splitting::strang(ExactFlow, Kicks).claims(Problem::Free) {
        let source =
            "Jacobi, J. reine angew. Math. 39 (1850) 293; two theta functions, constants in double-double";
        table.push(cells("exact".into(), None, &claims, "1 evaluation at any time".into(), source));
    }
    for method in catalogue() {
        let Some(claims) = method.claims(Problem::Free) else { continue };
        // where free motion is exact, the order of motion in a potential
        let in_potential = || method.claims(Problem::Potential).and_then(|claims| claims.order);
        let order = claims.order.or_else(in_potential);
        table.push(cells(method.name(), order, &claims, claims.cost.to_string(), claims.source));
    }
    table
}

/// The same with the methods that have a name on the command line and stand outside of the catalogue: one step of a simulator, which no
/// experiment takes, and the motion of a body with inner friction, which is another problem.
pub fn listed() -> Table {
    let mut table = table();
    let euler = LinearlyImplicitEuler;
    // its claims are those of any loss
    let method = |parts: Dissipating| Splitting::of_flows(parts, schemes::STRANG).ok();
    let friction = Dissipating::new(1e-3).ok().and_then(method);
    for (name, claims) in [
        (euler.name(), euler.claims(Problem::Free)),
        ("dissipating:LOSS".into(), friction.and_then(|friction| friction.claims(Problem::Free))),
    ] {
        let Some(claims) = claims else { continue };
        table.push(cells(name, claims.order, &claims, claims.cost.to_string(), claims.source));
    }
    table
}

fn cells(name: String, order: Option<u32>, claims: &Claims, cost: String, source: &str) -> [Cell; 13] {
    let yes = |kept: bool| if kept { "yes" } else { "no" };
    let kept = claims.kept;
    let listing = listing(&name);
    row![
        name,
        order.map(u64::from),
        kept.energy.to_string(),
        yes(kept.momentum_norm),
        yes(kept.momentum_space),
        yes(kept.norm),
        yes(claims.symmetric),
        yes(claims.poisson),
        yes(claims.symplectic),
        cost,
        source,
        listing.map(|listing| listing.formula),
        listing.map(|listing| listing.file),
    ]
}

/// One row a scheme that can be named behind the `@` of a method.
pub fn schemes() -> Table {
    let mut table = Table::new(
        "schemes",
        "Schemes, to be named behind the base of a method; a composition raises the order of any symmetric base, the others \
         alternate two flows, exact or at least of the order of the scheme, as in kick-drift.",
        vec![
            Column::new("name", "", "name behind the @"),
            Column::new("order", "", "order of the whole"),
            Column::new("kind", "", "composition, or what the two flows have to be"),
            Column::new("maps", "", "maps of a composition, or free flows, in a step"),
            Column::new("kicks", "", "kicks in a step"),
            Column::new("source", "", "where the coefficients come from"),
        ],
    );
    for scheme in schemes::ALL {
        let flows = scheme.flows();
        let count = |part| flows.iter().filter(|flow| flow.0 == part).count() as u64;
        let kind = match scheme.stages() {
            Stages::Composition(_) => "composition".to_owned(),
            Stages::Alternating { pairs: Pairs::Any, .. } => "any two flows".to_owned(),
            Stages::Alternating { pairs: Pairs::Nystrom, .. } => "kinetic and potential".to_owned(),
            Stages::Alternating {
                pairs: Pairs::NearIntegrable(orders) | Pairs::NearIntegrableNystrom(orders),
                ..
            }
            | Stages::ProcessedAlternating {
                pairs: Pairs::NearIntegrable(orders) | Pairs::NearIntegrableNystrom(orders),
                ..
            } => {
                let orders: Vec<String> = orders.iter().map(u32::to_string).collect();
                format!("weak potential ({})", orders.join(","))
            }
            Stages::ForceGradient { .. } => "kinetic and potential, force gradient".to_owned(),
            Stages::Processed { .. } => "composition, processed".to_owned(),
            Stages::ProcessedAlternating { .. } => "two flows, processed".to_owned(),
        };
        table.push(row![
            scheme.name(),
            u64::from(scheme.order()),
            kind,
            count(Part::A),
            count(Part::B),
            scheme.source(),
        ]);
    }
    table
}
