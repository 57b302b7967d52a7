"""Writes coefficients.csv and prints the lists of src/method/combine/schemes.

    python3 tests/data/schemes/generate.py        (python 3.11, mpmath 1.3)

Coefficients are the printed digits of the sources named there, or are computed here with 40 digits where a
closed form or as many conditions as unknowns define them. Only the part of the first half that the sums leave free
is listed. Each coefficient is rounded to a multiple of 2^-104, so that a double-double number holds every sum of
coefficients exactly; that changes none by more than 2.5e-32.
"""

import csv
from fractions import Fraction
from pathlib import Path

from mpmath import cbrt, findroot, mp, mpf, nstr, polyroots, sqrt, taylor, legendre

from force_gradient import force_gradient
from processed import blanes_casas_murua, processed_6_4

HERE = Path(__file__).parent
GRID = 2**104
mp.dps = 50


def digits(text):
    """Printed numbers, one after the other."""
    return text.split()


def mclachlan_4():
    """The second length, from the condition of order 4 and a first length of 0.28."""
    first = mpf("0.28")
    return ["0.28", findroot(lambda g: 2 * (first**3 + g**3) + (1 - 2 * (first + g)) ** 3, mpf("0.6254664284676700"))]


def mclachlan_s5():
    root = sqrt(19)
    return {"a": ["0.4", "-0.1"], "b": [(14 - root) / 108, (20 - 7 * root) / 108]}


def aba_8_4():
    """Four lengths from four conditions: order 8 of the quadrature with nodes sum(a) and weights b, and the one
    condition of degree 3 that is of second order in B. The start has the digits of McLachlan (1995)."""

    def conditions(a1, a2, b1, b2):
        a = [a1, a2, mpf(1) / 2 - a1 - a2]
        b = [b1, b2, 1 - 2 * (b1 + b2), b2, b1]
        a += a[::-1]
        moments = [
            sum(weight * (sum(a[: n + 1]) - mpf(1) / 2) ** power for n, weight in enumerate(b))
            - mpf(1) / ((power + 1) * 2**power)
            for power in (2, 4, 6)
        ]
        return moments + [sum(length * sum(b[n:]) ** 2 for n, length in enumerate(a)) - mpf(1) / 3]

    start = "0.07534696026989288842 0.51791685468825678230 0.19022593937367661925 0.84652407044352625706"
    found = list(findroot(conditions, [mpf(x) for x in start.split()]))
    return {"a": found[:2], "b": found[2:]}


def saba(n):
    """Differences of the nodes of Gauss and Legendre on [0, 1], and their weights."""
    polynomial = taylor(lambda x: legendre(n, x), 0, n)[::-1]
    nodes = sorted(polyroots(polynomial, maxsteps=200, extraprec=200))
    derivative = [c * (n - k) for k, c in enumerate(polynomial[:-1])]
    slope = lambda x: sum(c * x ** (n - 1 - k) for k, c in enumerate(derivative))
    weights = [1 / ((1 - x * x) * slope(x) ** 2) for x in nodes]
    ends = [mpf(0)] + [(1 + x) / 2 for x in nodes]
    lengths = [after - before for before, after in zip(ends, ends[1:])]
    return {"a": lengths[: n // 2], "b": weights[: (n - 1) // 2]}


SUZUKI = 1 / (4 - cbrt(4))

SCHEMES = {
    "strang": {"gamma": []},
    "yoshida-4": {"gamma": [1 / (2 - cbrt(2))]},
    "suzuki-4": {"gamma": [SUZUKI, SUZUKI]},
    "mclachlan-4": {"gamma": mclachlan_4()},
    "yoshida-6": {"gamma": digits("0.78451361047755726381949763 0.23557321335935813368479318 "
                                  "-1.17767998417887100694641568")},
    "kahan-li-6": {"gamma": digits("0.39216144400731413927925056 0.33259913678935943859974864 "
                                   "-0.70624617255763935980996482 0.08221359629355080023149045")},
    "sofroniou-spaletta-6": {"gamma": digits(
        "0.21375583945878254555518066964857 0.18329381407425713911385974425217 "
        "0.17692819473098943794898811709929 -0.44329082681170215849622829626258 "
        "0.11728560432865935385403585669136")},
    "suzuki-umeno-8": {"gamma": digits(
        "0.74167036435061295344822780 -0.40910082580003159399730010 0.19075471029623837995387626 "
        "-0.57386247111608226665638773 0.29906418130365592384446354 0.33462491824529818378495798 "
        "0.31529309239676659663205666")},
    "kahan-li-8": {"gamma": digits(
        "0.13020248308889008087881763 0.56116298177510838456196441 -0.38947496264484728640807860 "
        "0.15884190655515560089621075 -0.39590389413323757733623154 0.18453964097831570709183254 "
        "0.25837438768632204729397911 0.29501172360931029887096624")},
    "sofroniou-spaletta-8": {"gamma": digits(
        "0.10647728984550031823931967854896 0.10837408645835726397433410591546 "
        "0.35337821052654342419534541324080 -0.23341414023165082198780281128319 "
        "-0.24445266791528841269462171413216 0.11317848435755633314700952515599 "
        "0.11892905625000350062692972283951 0.12603912321825988140305670268365 "
        "0.12581718736176041804392391641587 0.11699135019217642180722881433533")},
    "sofroniou-spaletta-10": {"gamma": digits(
        "0.078795722521686419263907679337684 0.31309610341510852776481247192647 "
        "0.027918383235078066109520273275299 -0.22959284159390709415121339679655 "
        "0.13096206107716486317465685927961 -0.26973340565451071434460973222411 "
        "0.074973343155891435666137105641410 0.11199342399981020488957508073640 "
        "0.36613344954622675119314812353150 -0.39910563013603589787862981058340 "
        "0.10308739852747107731580277001372 0.41143087395589023782070411897608 "
        "-0.0048663605831352617621956593099771 -0.39203335370863990644808193642610 "
        "0.051942502962449647037182904015976 0.050665090759924496335874344156866 "
        "0.049674370639729879054568800279461")},
    "mclachlan-s5": mclachlan_s5(),
    "blanes-moan-s6": {"a": digits("0.209515106613362 -0.143851773179818"),
                       "b": digits("0.0792036964311957 0.353172906049774 -0.0420650803577195")},
    "blanes-moan-s10": {
        "a": digits("0.148816447901042 -0.132385865767784 0.067307604692185 0.432666402578175"),
        "b": digits("0.0502627644003922 0.413514300428344 0.0450798897943977 -0.188054853819569 0.541960678450780")},
    "srkn-6b": {"a": digits("0.245298957184271 0.604872665711080"),
                "b": digits("0.0829844064174052 0.396309801498368 -0.0390563049223486")},
    "srkn-11b": {
        "a": digits("0.123229775946271 0.290553797799558 -0.127049212625417 -0.246331761062075 0.357208872795928"),
        "b": digits("0.0414649985182624 0.198128671918067 -0.0400061921041533 0.0752539843015807 "
                    "-0.0115113874206879")},
    "srkn-14a": {
        "a": digits("0.03785931984061157 0.102635633102435 -0.02586788826655869 0.314241403071447 "
                    "-0.130144459517415 0.106417700369543 -0.008794243128510581"),
        "b": digits("0.09171915262446165 0.183983170005006 -0.05653436583288827 0.004914688774712854 "
                    "0.143761127168358 0.328567693746804")},
    "bce-22": {
        "a": digits("0.0505805 0.149999 -0.0551795510771615573511026950361 0.423755898835337951482264998051 "
                    "-0.213495353584659048059672194633 -0.0680769774574032619111630736274 "
                    "0.227917056974013435948887201671 -0.235373619381058906524740047732 "
                    "0.387413869179878047816794031058"),
        "b": digits("0.129478606560536730662493794395 0.222257260092671143423043559581 "
                    "-0.0577514893325147204757023246320 -0.0578312262103924910221345032763 "
                    "0.103087297437175356747933252265 -0.140819612554090768205554103887 "
                    "0.0234462603492826276699713718626 0.134854517356684096617882205068 "
                    "0.0287973821073779306345172160211")},
    "saba-2": saba(2),
    "saba-3": saba(3),
    "saba-4": saba(4),
    "aba-8-4": aba_8_4(),
    "aba-8-6-4": {
        "a": digits("0.0711334264982231177779387300061549964174 0.241153427956640098736487795326289649618 "
                    "0.521411761772814789212136078067994229991"),
        "b": digits("0.183083687472197221961703757166430291072 0.310782859898574869507522291054262796375 "
                    "-0.0265646185119588006972121379164987592663")},
    "aba-10-6-4": {
        "a": digits("0.03809449742241219545697532230863756534060 0.1452987161169137492940200726606637497442 "
                    "0.2076276957255412507162056113249882065158 0.4359097036515261592231548624010651844006"),
        "b": digits("0.09585888083707521061077150377145884776921 0.2044461531429987806805077839164344779763 "
                    "0.2170703479789911017143385924306336714532")},
    **force_gradient(),
    **blanes_casas_murua(),
    "processed-6-4": processed_6_4(),
}


def shown(value):
    return value if isinstance(value, str) else nstr(value, 40)


def parts(value):
    """The two doubles of the multiple of 2^-104 that is nearest to a decimal number."""
    near = Fraction(round(Fraction(value) * GRID), GRID)
    high = float(near)
    low = float(near - Fraction(high))
    assert Fraction(high) + Fraction(low) == near
    return high, low


def main():
    rows = [
        (name, part, number, shown(value))
        for name, lists in SCHEMES.items()
        for part, values in lists.items()
        for number, value in enumerate(values, 1)
    ]
    with open(HERE / "coefficients.csv", "w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["scheme", "part", "number", "value"])
        out.writerows(rows)
    for name, part, number, value in rows:
        if number == 1:
            print(f"// {name} {part}")
        print("Dd::sum({!r}, {!r}),".format(*parts(value)))


main()
