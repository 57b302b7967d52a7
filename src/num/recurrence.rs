//! The recurrences of the operations of a law, by which the next coefficient of each is worked out.

use core::ops::Range;

use super::Real;

/// How the coefficients of an entry follow from those of others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// From outside.
    Given,
    /// Of a straight line in the time, whose slope is the number of the entry.
    Line,
    /// Over the time in seconds.
    Integral,
    Sum,
    Difference,
    /// By a number, which shows in the first coefficient alone.
    Shifted,
    Negative,
    Product,
    /// By the number of the entry.
    Scaled,
    Quotient,
    /// Of a number.
    Reciprocal,
    Root,
    /// n cₙ.
    Slope,
    /// By the slope of the angle, and the cosine.
    Sine,
    /// By the slope of the angle, and the sine.
    Cosine,
    /// By the straight line that is the angle, and the cosine.
    LineSine,
    /// By the straight line that is the angle, and the sine.
    LineCosine,
}

/// An operation on entries: one that takes one has it twice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Operation {
    pub(super) kind: Kind,
    pub(super) terms: [u32; 2],
}

impl Operation {
    /// The entries that it is made of.
    fn uses(&self) -> &[u32] {
        match self.kind {
            Kind::Given | Kind::Line => &[],
            Kind::Sum | Kind::Difference | Kind::Product | Kind::Quotient => &self.terms,
            Kind::Sine | Kind::Cosine | Kind::LineSine | Kind::LineCosine => &self.terms,
            _ => &self.terms[..1],
        }
    }

    /// Whether it is a sum of products and multiples.
    fn is_sum(&self) -> bool {
        self.is_multiple() || matches!(self.kind, Kind::Sum | Kind::Difference | Kind::Product)
    }

    /// Whether all coefficients, but the first of one that is shifted, are those of one entry times a number.
    fn is_multiple(&self) -> bool {
        matches!(self.kind, Kind::Shifted | Kind::Negative | Kind::Scaled)
    }
}

/// The products that are summed side by side, each to a sum of its own.
const LANES: usize = 4;

/// No place.
const NOWHERE: u32 = u32::MAX;

/// What works out the coefficients of an entry.
#[derive(Clone, Debug)]
struct Step {
    kind: Kind,
    entry: u32,
    /// The terms that it takes: of a sum those that are products.
    terms: Range<usize>,
    /// Of a sum the terms that are multiples.
    multiples: Range<usize>,
    /// Where its coefficients begin, if products take them.
    row: u32,
}

/// A term of a sum, or what another step takes.
#[derive(Clone, Copy, Debug)]
struct Term<S> {
    /// Places of steps for multiples, rows for products.
    of: [u32; 2],
    factor: S,
}

/// The factor of a term of a sum: a sign, and the numbers of entries.
#[derive(Clone, Debug, Default)]
struct Factor {
    is_negative: bool,
    numbers: Vec<u32>,
}

/// What a law does, with the coefficients of the power worked out last, and of all powers where products ask for them.
///
/// Sums of sums, multiples and products are one step. The coefficient n of a product is the sum of four sums, that of every
/// fourth `a_k b_{n−k}`.
#[derive(Clone, Debug)]
pub(super) struct Recurrence<S> {
    width: usize,
    arguments: usize,
    steps: Vec<Step>,
    terms: Vec<Term<S>>,
    factors: Vec<Factor>,
    /// By entry, the step.
    places: Vec<u32>,
    /// By step, the coefficient of the last power.
    last: Vec<S>,
    /// Coefficients from the first on, with zeros behind, and from the last on, with zeros behind the first.
    ascending: Vec<S>,
    descending: Vec<S>,
    /// The last coefficients that integrals are over, and their steps.
    rates: Vec<(S, u32)>,
    /// 1/n.
    shares: Vec<S>,
}

/// Finds out which entries need a step, and of which terms their sums are.
struct Arranger<'a> {
    operations: &'a [Operation],
    /// How often each entry is used.
    uses: Vec<u32>,
    has_step: Vec<bool>,
    has_row: Vec<bool>,
    /// Whether sums take the terms of others for their own.
    merges: bool,
    products: Vec<([u32; 2], Factor)>,
    multiples: Vec<([u32; 2], Factor)>,
}

impl Arranger<'_> {
    /// The entry of which `k` is a multiple in all coefficients, the factor multiplied by that.
    fn base(&self, mut k: u32, factor: &mut Factor) -> u32 {
        if !self.merges {
            return k;
        }
        loop {
            let Operation { kind, terms } = self.operations[k as usize];
            match kind {
                Kind::Negative => factor.is_negative ^= true,
                Kind::Scaled => factor.numbers.push(k),
                _ => return k,
            }
            k = terms[0];
        }
    }

    /// Adds what the sum `k` is made of, times `factor`, to the terms.
    fn expand(&mut self, k: u32, mut factor: Factor) {
        let Operation { kind, terms: [a, b] } = self.operations[k as usize];
        match kind {
            Kind::Sum => {
                self.add(a, factor.clone());
                self.add(b, factor);
            }
            Kind::Difference => {
                self.add(a, factor.clone());
                factor.is_negative ^= true;
                self.add(b, factor);
            }
            Kind::Negative => {
                factor.is_negative ^= true;
                self.add(a, factor);
            }
            Kind::Shifted => self.add(a, factor),
            Kind::Scaled => {
                factor.numbers.push(k);
                self.add(a, factor);
            }
            Kind::Product => {
                let rows = [self.base(a, &mut factor), self.base(b, &mut factor)];
                for k in rows {
                    self.has_step[k as usize] = true;
                    self.has_row[k as usize] = true;
                }
                self.products.push((rows, factor));
            }
            _ => {}
        }
    }

    /// Adds the entry `k` times `factor` to the terms: by what it is made of where nothing else asks for it.
    fn add(&mut self, k: u32, factor: Factor) {
        let operation = self.operations[k as usize];
        let alone = self.uses[k as usize] == 1 && operation.is_sum();
        if self.merges && !self.has_step[k as usize] && (alone || operation.is_multiple()) {
            self.expand(k, factor);
        } else {
            self.has_step[k as usize] = true;
            self.multiples.push(([k, 0], factor));
        }
    }
}

impl<S: Real> Recurrence<S> {
    pub(super) fn new(width: usize) -> Self {
        let share = |n: usize| S::of(1.0) / S::of(n.max(1) as f64);
        Recurrence {
            width,
            arguments: 0,
            steps: Vec::new(),
            terms: Vec::new(),
            factors: Vec::new(),
            places: Vec::new(),
            last: Vec::new(),
            ascending: Vec::new(),
            descending: Vec::new(),
            rates: Vec::new(),
            shares: (0..width).map(share).collect(),
        }
    }

    /// Finds the steps for what `operations` do of which the entries `results` depend; where nothing `merges`, one for each.
    pub(super) fn arrange(
        &mut self,
        operations: &[Operation],
        arguments: usize,
        results: &[u32],
        merges: bool,
    ) {
        self.arguments = arguments;
        let count = operations.len();
        let mut uses = vec![0; count];
        let mut open: Vec<u32> = results.to_vec();
        while let Some(k) = open.pop() {
            uses[k as usize] += 1;
            if uses[k as usize] == 1 {
                open.extend(operations[k as usize].uses());
            }
        }
        let (mut has_step, mut has_row) = (vec![false; count], vec![false; count]);
        (0..arguments).for_each(|k| (has_step[k], has_row[k]) = (true, true));
        results.iter().for_each(|k| (has_step[*k as usize], has_row[*k as usize]) = (true, true));
        for (k, operation) in operations.iter().enumerate().filter(|(k, _)| uses[*k] > 0) {
            let [a, b] = operation.terms.map(|k| k as usize);
            has_step[k] |= !(merges && operation.is_sum());
            match operation.kind {
                Kind::Integral | Kind::Slope => has_step[a] = true,
                Kind::Root => (has_step[a], has_row[k]) = (true, true),
                Kind::Quotient | Kind::Reciprocal => {
                    (has_step[a], has_step[b], has_row[b], has_row[k]) = (true, true, true, true);
                }
                Kind::Sine | Kind::Cosine => (has_step[a], has_row[a], has_row[b]) = (true, true, true),
                Kind::LineSine | Kind::LineCosine => has_row[b] = true,
                _ => {}
            }
        }
        let (products, multiples) = (Vec::new(), Vec::new());
        let mut found = Arranger { operations, uses, has_step, has_row, merges, products, multiples };
        self.steps.clear();
        let mut terms = Vec::new();
        // from the last on, so that all is known that asks for an entry
        for (k, operation) in operations.iter().enumerate().rev() {
            if !found.has_step[k] {
                continue;
            }
            let entry = k as u32;
            if operation.is_sum() {
                found.expand(entry, Factor::default());
            } else {
                found.multiples.push((operation.terms, Factor::default()));
            }
            let from = terms.len();
            terms.append(&mut found.products);
            let split = terms.len();
            terms.append(&mut found.multiples);
            let (terms, multiples) = (from..split, split..terms.len());
            self.steps.push(Step { kind: operation.kind, entry, terms, multiples, row: NOWHERE });
        }
        self.steps.reverse();
        self.places.clear();
        self.places.resize(count, NOWHERE);
        let stride = self.width + LANES;
        let mut end = 0;
        for (place, step) in self.steps.iter_mut().enumerate() {
            self.places[step.entry as usize] = place as u32;
            if found.has_row[step.entry as usize] {
                step.row = end as u32;
                end += stride;
            }
        }
        let place = |k: u32| self.places[k as usize];
        let row = |k: u32| self.steps.get(place(k) as usize).map_or(NOWHERE, |step| step.row);
        self.terms.clear();
        self.terms.resize(terms.len(), Term { of: [0; 2], factor: S::of(1.0) });
        self.rates.clear();
        for step in &self.steps {
            for term in step.terms.clone() {
                self.terms[term].of = terms[term].0.map(row);
            }
            for term in step.multiples.clone() {
                let [a, b] = terms[term].0;
                self.terms[term].of = match step.kind {
                    Kind::Given | Kind::Line => [step.entry, 0],
                    Kind::Sine | Kind::Cosine => [row(a), row(b)],
                    Kind::LineSine | Kind::LineCosine => [a, row(b)],
                    Kind::Quotient | Kind::Reciprocal => [place(a), row(b)],
                    _ => [place(a), 0],
                };
            }
            if step.kind == Kind::Integral {
                self.rates.push((S::of(0.0), place(operations[step.entry as usize].terms[0])));
            }
        }
        self.factors = terms.into_iter().map(|(_, factor)| factor).collect();
        self.last.resize(self.steps.len(), S::of(0.0));
        for rows in [&mut self.ascending, &mut self.descending] {
            rows.clear();
            rows.resize(end, S::of(0.0));
        }
    }

    /// The coefficient `power` of an entry that products or results ask for.
    pub(super) fn coefficient(&self, entry: u32, power: usize) -> Option<S> {
        let step = self.steps.get(*self.places.get(entry as usize)? as usize)?;
        self.ascending.get(step.row as usize + power).copied()
    }

    /// The first entry whose last coefficient is not finite.
    pub(super) fn not_finite(&self) -> Option<usize> {
        let place = self.last.iter().position(|c| !c.magnitude().is_finite())?;
        self.steps.get(place).map(|step| step.entry as usize)
    }

    /// Takes the first coefficients and the numbers of all entries.
    pub(super) fn begin(&mut self, firsts: &[S], numbers: &[S]) {
        for (term, Factor { is_negative, numbers: of }) in self.terms.iter_mut().zip(&self.factors) {
            let product = of.iter().fold(S::of(1.0), |product, k| product * numbers[*k as usize]);
            term.factor = if *is_negative { -product } else { product };
        }
        for place in 0..self.steps.len() {
            self.keep(place, 0, firsts[self.steps[place].entry as usize]);
        }
    }

    /// Works out the coefficients `n`, above 0, from those of the arguments, the numbers of the entries and the unit.
    pub(super) fn next(&mut self, n: usize, arguments: &[S], numbers: &[S], unit: S) {
        for (rate, place) in &mut self.rates {
            *rate = self.last[*place as usize];
        }
        let (zero, share) = (S::of(0.0), self.shares[n]);
        // the arguments are the first
        for (place, argument) in arguments.iter().enumerate().take(self.arguments) {
            self.keep(place, n, *argument);
        }
        let mut rates = 0;
        for place in self.arguments..self.steps.len() {
            let Step { kind, ref terms, ref multiples, row, .. } = self.steps[place];
            let [a, b] = self.terms.get(multiples.start).map_or([0; 2], |term| term.of);
            let of = |place: u32| self.last[place as usize];
            let convolution = |a: u32, b: u32, range: Range<usize>| self.single_convolution([a, b], range, n);
            let coefficient = match kind {
                Kind::Line => {
                    if n == 1 {
                        numbers[a as usize] * unit
                    } else {
                        zero
                    }
                }
                Kind::Integral => {
                    rates += 1;
                    self.rates[rates - 1].0 * unit * share
                }
                Kind::Slope => of(a) * S::of(n as f64),
                // q_n = (a_n − Σ b_k q_{n−k})/b₀, 0 < k ≤ n
                Kind::Quotient => (of(a) - convolution(b, row, 1..n + 1)) / self.ascending[b as usize],
                Kind::Reciprocal => -convolution(b, row, 1..n + 1) / self.ascending[b as usize],
                // 2 r₀ r_n = a_n − Σ r_k r_{n−k}, 0 < k < n
                Kind::Root => {
                    let (a, first) = (of(a), self.ascending[row as usize]);
                    if first.magnitude() == 0.0 && a.magnitude() == 0.0 {
                        a
                    } else {
                        (a - convolution(row, row, 1..n)) / (first + first)
                    }
                }
                // n s_n = Σ k a_k c_{n−k} and n c_n = −Σ k a_k s_{n−k}, 0 < k ≤ n
                Kind::Sine => convolution(a, b, 1..n + 1) * share,
                Kind::Cosine => -(convolution(a, b, 1..n + 1) * share),
                Kind::LineSine | Kind::LineCosine => {
                    let change = numbers[a as usize] * unit * self.ascending[b as usize + n - 1] * share;
                    if kind == Kind::LineSine { change } else { -change }
                }
                _ => {
                    let mut sum = zero;
                    for Term { of, factor } in &self.terms[terms.clone()] {
                        sum = sum + self.convolution(*of, 0..n + 1, n) * *factor;
                    }
                    for Term { of: [a, _], factor } in &self.terms[multiples.clone()] {
                        sum = sum + of(*a) * *factor;
                    }
                    sum
                }
            };
            self.keep(place, n, coefficient);
        }
    }

    /// Keeps the coefficient `n` of a step.
    #[inline(always)]
    fn keep(&mut self, place: usize, n: usize, c: S) {
        self.last[place] = c;
        let (row, zero) = (self.steps[place].row, S::of(0.0));
        if row != NOWHERE {
            // what is behind is left from the series before
            self.ascending[row as usize + n..][..LANES].copy_from_slice(&[c, zero, zero, zero]);
            self.descending[row as usize + self.width - 1 - n] = c;
        }
    }

    #[inline(never)]
    fn single_convolution(&self, rows: [u32; 2], range: Range<usize>, n: usize) -> S {
        self.convolution(rows, range, n)
    }

    /// `Σ a_k b_{n−k}`, k in `range`, of two rows, and zeros up to a multiple of the lanes.
    #[inline(always)]
    fn convolution(&self, [a, b]: [u32; 2], range: Range<usize>, n: usize) -> S {
        let (first, length) = (range.start, range.len().next_multiple_of(LANES));
        let ascending = &self.ascending[a as usize + first..][..length];
        let descending = &self.descending[b as usize + self.width - 1 - n + first..][..length];
        let mut sums = [S::of(0.0); LANES];
        for (a, b) in ascending.chunks_exact(LANES).zip(descending.chunks_exact(LANES)) {
            for lane in 0..LANES {
                sums[lane] = sums[lane] + a[lane] * b[lane];
            }
        }
        (sums[0] + sums[2]) + (sums[1] + sums[3])
    }
}
