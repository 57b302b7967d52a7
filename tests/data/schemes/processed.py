"""Coefficients of processed schemes to 40 digits, from the printed ones, by Newton's method on their order conditions.

A step of a symmetric map of order 2 is exp(g Y1 + g^3 Y3 + g^5 Y5 + ...) with letters Yk of weight k that do not commute, a
series in words. In time the processor P comes first, then the kernel K, then the inverse of P: the product is exp(Y1) up to words
of the weight of the order. Of two flows A and B the letters are these two, both of weight 1, and the product is exp(A + B).
"""

from functools import cache

from mpmath import factorial, matrix, mp, mpf, sqrt

mp.dps = 60


@cache
def words(weights, most):
    """All words of at most this weight, the empty one first; each is followed by all that it begins."""
    found = {(): 0}
    queue = [((), 0)]
    for word, weight in queue:
        for letter, w in enumerate(weights):
            if weight + w <= most:
                longer = word + (letter,)
                found[longer] = weight + w
                queue.append((longer, weight + w))
    return found


def exponential(parts, table):
    """exp of a sum of letters: a word has the product of the factors of its letters, over the factorial of its length."""
    series = {}
    for word in table:
        product = 1 / factorial(len(word))
        for letter in word:
            product *= parts[letter]
        if product:
            series[word] = product
    return series


def product(left, right, table):
    """The words of `left` before those of `right`: `left` comes first in time."""
    result = {}
    for a, x in left.items():
        for b, y in right.items():
            word = a + b
            if word in table:
                result[word] = result.get(word, 0) + x * y
    return result


def closed(kernel):
    """The whole of a palindrome with sum 1."""
    return kernel + [1 - 2 * sum(kernel)] + kernel[::-1]


def composition(steps, order):
    """The words of a composition less those of the exact step."""
    weights = tuple(range(1, order + 1, 2))
    table = words(weights, order)
    series = {(): mpf(1)}
    for step in steps:
        series = product(series, exponential([step**w for w in weights], table), table)
    exact = exponential([mpf(1)] + [mpf(0)] * (len(weights) - 1), table)
    return [series.get(word, 0) - exact.get(word, 0) for word in table if word]


def processed_defects(kernel, half, order):
    before = half + [-p for p in half]
    after = [-p for p in before[::-1]]
    return composition(before + closed(kernel) + after, order)


def alternating(a, b):
    """Flows of A (letter 0) and B (letter 1) in turn."""
    return [flow for pair in zip(a, b) for flow in zip((0, 1), pair)]


def nystrom_defects(kernel, processor, powers):
    """As above with two flows, up to words of powers[k - 1] letters of which k are B. Those with three B in four are left out: for
    A quadratic in the momenta and B a function of the attitude their bracket is zero, [B,[B,[B,A]]] = 0."""
    table = words((1, 1), max(powers))
    series = {(): mpf(1)}
    for letter, share in processor + kernel + [(letter, -share) for letter, share in processor[::-1]]:
        parts = [mpf(0), mpf(0)]
        parts[letter] = share
        series = product(series, exponential(parts, table), table)
    exact = exponential([mpf(1), mpf(1)], table)
    counted = lambda word: word and len(word) <= ([max(powers)] + powers)[min(sum(word), len(powers))] and sum(word) < 3
    return [series.get(word, 0) - exact.get(word, 0) for word in table if counted(word)]


def polished(defects, start):
    """The root of `defects` next to `start`: Newton's method on more conditions than unknowns, which are consistent."""
    x = [mpf(value) for value in start]
    for _ in range(8):
        f = defects(x)
        size = max(abs(value) for value in f)
        if size < mpf(10) ** -45:
            return x
        step = mpf(10) ** -25
        columns = []
        for k in range(len(x)):
            moved = list(x)
            moved[k] += step
            ahead = defects(moved)
            moved[k] -= 2 * step
            behind = defects(moved)
            columns.append([(a - b) / (2 * step) for a, b in zip(ahead, behind)])
        jacobian = matrix(len(f), len(x))
        for k, column in enumerate(columns):
            for row, value in enumerate(column):
                jacobian[row, k] = value
        # the shortest change that solves them: where there are fewer conditions than unknowns, some stay free
        u, sizes, v = mp.svd_r(jacobian)
        ahead = u.T * -matrix(f)
        scaled = matrix([a / s if s > mpf(10) ** -12 * sizes[0] else 0 for a, s in zip(ahead, sizes)])
        x = [value + change for value, change in zip(x, v.T * scaled)]
    raise ValueError(f"defect {size} is left")


def sequence(order, kernel, fixed, spread, printed):
    """Kernel and processor of a composition; `kernel` and `spread` make them of their unknowns, which begin at the printed digits."""
    start = fixed.split() + printed.split()
    known = len(fixed.split())
    lists = lambda x: (kernel(x[:known]), [-g for g in spread(x[known:])])
    found = polished(lambda x: processed_defects(*lists(x), order), start)
    return dict(zip(("kernel", "processor"), lists(found)))


def blanes_casas_murua():
    """Blanes, Casas & Murua, SIAM J. Sci. Comput. 27 (2006) 1817. Lengths that the source takes for free parameters stay."""
    first = lambda g: [-sum(g)] + g
    return {
        "blanes-casas-murua-6-11": sequence(
            6, lambda x: [x[0]] * 4 + x[1:], "0.1705768865009222157 -0.423366140892658048",
            lambda g: first(g + [mpf("-0.1")]), "-0.20621953139126 0.23651387483203 0.09086982276241 0.24687306977659"),
        "blanes-casas-murua-6-13": sequence(
            6, lambda x: [x[0]] * 4 + x[1:], "0.125696288720106 0.148070660114965 -0.350856370823828",
            lambda g: [mpf("0.1")] + g + [-sum(g) - mpf("0.1")],
            "0.225080298761176 0.191244694511161 -0.212763792194890 -0.09660157306582295"),
        "blanes-casas-murua-8-13": sequence(
            8, lambda x: [mpf("0.168")] * 2 + x,
            "0.585550530805562 -0.460090457516872 0.172863148729731 0.179664539695039", first,
            "-0.008488123494574411 -0.337188967354338 0.333987768164597 0.588351189003849 0.162324207599241 "
            "-0.511744926116413 0.236885952363384 0.598212975943381 -0.543415765371656"),
        "blanes-casas-murua-10-23": sequence(
            10, lambda x: [x[0]] * 5 + x[1:],
            "0.121657748919383 -0.511318780154828 -0.172858614884985 0.123016258833066 0.441503951671565 "
            "-0.327071324165477 0.070952700957766", first,
            "0.4727142080578221 0.01344750613191108 -0.4637104712987078 -0.3045590922565247 -0.5382945821834320 "
            "-0.1899795533199732 0.1548256472553489 -0.3594148033156072 0.3430345669677392 0.5334030283695922 "
            "0.009116042043427756"),
    }


def processed_6_4():
    """Blanes, Casas & Murua, Acta Numer. 33 (2024) 1, table 8.5: a kernel of two stages."""
    root = sqrt(1 + 2 / sqrt(mpf(3)))
    kernel = {"kernel-a": [(1 - root) / 2, (1 + root) / 2], "kernel-b": [(1 + root) / 2, (1 - root) / 2]}
    lists = lambda x: ([mpf(0)] + x[:3], [mpf(-1) / 2] + x[3:])
    start = ("-0.4842296798457861 0.3104400973059574 0.9112603236884162 "
             "-0.071444491827245766 0.5119423407689261 -0.2256471548948410").split()
    flows = alternating(*kernel.values())
    a, b = lists(polished(lambda x: nystrom_defects(flows, alternating(*lists(x)), [6, 4]), start))
    # what closes the kernel is left out, and so is the first share of A, which is nothing
    return {part: shares[:1] for part, shares in kernel.items()} | {"processor-a": a[1:], "processor-b": b}
