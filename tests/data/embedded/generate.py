"""Prints the tables of src/method/embedded/dop853.rs and tsit5.rs, and by how much they miss the conditions of their orders.

    python3 tests/data/embedded/generate.py        (python 3.11, mpmath 1.3)

The digits are the printed ones of the sources named there: Hairer, Norsett & Wanner, Solving Ordinary Differential
Equations I (1993), II.5 and II.6, as in their code dop853.f; Tsitouras, Comput. Math. Appl. 62 (2011) 770, table 1.
"""

from mpmath import mp, mpf, nstr

mp.dps = 50


def rows(text):
    """`n: j value, j value, …` a line: what stage n takes of the stages j, counted from 1; the node is their sum."""
    table = {}
    for line in text.strip().splitlines():
        stage, entries = line.split(":")
        table[stage.strip()] = [(int(j), mpf(x)) for j, x in (entry.split() for entry in entries.split(","))]
    return table


DOP853 = rows("""
2: 1 5.26001519587677318785587544488e-2
3: 1 1.97250569845378994544595329183e-2, 2 5.91751709536136983633785987549e-2
4: 1 2.95875854768068491816892993775e-2, 3 8.87627564304205475450678981324e-2
5: 1 2.41365134159266685502369798665e-1, 3 -8.84549479328286085344864962717e-1, 4 9.24834003261792003115737966543e-1
6: 1 3.7037037037037037037037037037e-2, 4 1.70828608729473871279604482173e-1, 5 1.25467687566822425016691814123e-1
7: 1 3.7109375e-2, 4 1.70252211019544039314978060272e-1, 5 6.02165389804559606850219397283e-2, 6 -1.7578125e-2
8: 1 3.70920001185047927108779319836e-2, 4 1.70383925712239993810214054705e-1, 5 1.07262030446373284651809199168e-1, 6 -1.53194377486244017527936158236e-2, 7 8.27378916381402288758473766002e-3
9: 1 6.24110958716075717114429577812e-1, 4 -3.36089262944694129406857109825e0, 5 -8.68219346841726006818189891453e-1, 6 2.75920996994467083049415600797e1, 7 2.01540675504778934086186788979e1, 8 -4.34898841810699588477366255144e1
10: 1 4.77662536438264365890433908527e-1, 4 -2.48811461997166764192642586468e0, 5 -5.90290826836842996371446475743e-1, 6 2.12300514481811942347288949897e1, 7 1.52792336328824235832596922938e1, 8 -3.32882109689848629194453265587e1, 9 -2.03312017085086261358222928593e-2
11: 1 -9.3714243008598732571704021658e-1, 4 5.18637242884406370830023853209e0, 5 1.09143734899672957818500254654e0, 6 -8.14978701074692612513997267357e0, 7 -1.85200656599969598641566180701e1, 8 2.27394870993505042818970056734e1, 9 2.49360555267965238987089396762e0, 10 -3.0467644718982195003823669022e0
12: 1 2.27331014751653820792359768449e0, 4 -1.05344954667372501984066689879e1, 5 -2.00087205822486249909675718444e0, 6 -1.79589318631187989172765950534e1, 7 2.79488845294199600508499808837e1, 8 -2.85899827713502369474065508674e0, 9 -8.87285693353062954433549289258e0, 10 1.23605671757943030647266201528e1, 11 6.43392746015763530355970484046e-1
b: 1 5.42937341165687622380535766363e-2, 6 4.45031289275240888144113950566e0, 7 1.89151789931450038304281599044e0, 8 -5.8012039600105847814672114227e0, 9 3.1116436695781989440891606237e-1, 10 -1.52160949662516078556178806805e-1, 11 2.01365400804030348374776537501e-1, 12 4.47106157277725905176885569043e-2
14: 1 5.61675022830479523392909219681e-2, 7 2.53500210216624811088794765333e-1, 8 -2.46239037470802489917441475441e-1, 9 -1.24191423263816360469010140626e-1, 10 1.5329179827876569731206322685e-1, 11 8.20105229563468988491666602057e-3, 12 7.56789766054569976138603589584e-3, 13 -8.298e-3
15: 1 3.18346481635021405060768473261e-2, 6 2.83009096723667755288322961402e-2, 7 5.35419883074385676223797384372e-2, 8 -5.49237485713909884646569340306e-2, 11 -1.08347328697249322858509316994e-4, 12 3.82571090835658412954920192323e-4, 13 -3.40465008687404560802977114492e-4, 14 1.41312443674632500278074618366e-1
16: 1 -4.28896301583791923408573538692e-1, 6 -4.69762141536116384314449447206e0, 7 7.68342119606259904184240953878e0, 8 4.06898981839711007970213554331e0, 9 3.56727187455281109270669543021e-1, 13 -1.39902416515901462129418009734e-3, 14 2.9475147891527723389556272149e0, 15 -9.15095847217987001081870187138e0
error 5: 1 0.1312004499419488073250102996e-1, 6 -0.1225156446376204440720569753e1, 7 -0.4957589496572501915214079952e0, 8 0.1664377182454986536961530415e1, 9 -0.3503288487499736816886487290e0, 10 0.3341791187130174790297318841e0, 11 0.8192320648511571246570742613e-1, 12 -0.2235530786388629525884427845e-1
of order 3: 1 0.244094488188976377952755905512, 9 0.733846688281611857341361741547, 12 0.220588235294117647058823529412e-1
dense 4: 1 -0.84289382761090128651353491142e1, 6 0.56671495351937776962531783590, 7 -0.30689499459498916912797304727e1, 8 0.23846676565120698287728149680e1, 9 0.21170345824450282767155149946e1, 10 -0.87139158377797299206789907490, 11 0.22404374302607882758541771650e1, 12 0.63157877876946881815570249290, 13 -0.88990336451333310820698117400e-1, 14 0.18148505520854727256656404962e2, 15 -0.91946323924783554000451984436e1, 16 -0.44360363875948939664310572000e1
dense 5: 1 0.10427508642579134603413151009e2, 6 0.24228349177525818288430175319e3, 7 0.16520045171727028198505394887e3, 8 -0.37454675472269020279518312152e3, 9 -0.22113666853125306036270938578e2, 10 0.77334326684722638389603898808e1, 11 -0.30674084731089398182061213626e2, 12 -0.93321305264302278729567221706e1, 13 0.15697238121770843886131091075e2, 14 -0.31139403219565177677282850411e2, 15 -0.93529243588444783865713862664e1, 16 0.35816841486394083752465898540e2
dense 6: 1 0.19985053242002433820987653617e2, 6 -0.38703730874935176555105901742e3, 7 -0.18917813819516756882830838328e3, 8 0.52780815920542364900561016686e3, 9 -0.11573902539959630126141871134e2, 10 0.68812326946963000169666922661e1, 11 -0.10006050966910838403183860980e1, 12 0.77771377980534432092869265740, 13 -0.27782057523535084065932004339e1, 14 -0.60196695231264120758267380846e2, 15 0.84320405506677161018159903784e2, 16 0.11992291136182789328035130030e2
dense 7: 1 -0.25693933462703749003312586129e2, 6 -0.15418974869023643374053993627e3, 7 -0.23152937917604549567536039109e3, 8 0.35763911791061412378285349910e3, 9 0.93405324183624310003907691704e2, 10 -0.37458323136451633156875139351e2, 11 0.10409964950896230045147246184e3, 12 0.29840293426660503123344363579e2, 13 -0.43533456590011143754432175058e2, 14 0.96324553959188282948394950600e2, 15 -0.39177261675615439165231486172e2, 16 -0.14972683625798562581422125276e3
""")

TSIT5 = rows("""
2: 1 0.161
3: 1 -0.008480655492356989, 2 0.335480655492357
4: 1 2.8971530571054935, 2 -6.359448489975075, 3 4.3622954328695815
5: 1 5.325864828439257, 2 -11.748883564062828, 3 7.4955393428898365, 4 -0.09249506636175525
6: 1 5.86145544294642, 2 -12.92096931784711, 3 8.159367898576159, 4 -0.071584973281401, 5 -0.028269050394068383
b: 1 0.09646076681806523, 2 0.01, 3 0.4798896504144996, 4 1.379008574103742, 5 -3.290069515436081, 6 2.324710524099774
error 4: 1 -0.00178001105222577714, 2 -0.0008164344596567469, 3 0.007880878010261995, 4 -0.1447110071732629, 5 0.5823571654525552, 6 -0.45808210592918697, 7 0.015151515151515152
""")

# of theta^2, theta^3 and theta^4; theta is that of stage 1 alone
DENSE_TSIT5 = """
1: -1.0530884977290216 1.3299890189751412 1.4364028541716351 0.7139816917074209
2: 0.1017 2.1966568338249754 1.2949852507374631
3: 2.490627285651252793 2.38535645472061657 1.57803468208092486
4: -16.54810288924490272 1.21712927295533244 0.61620406037800089
5: 47.37952196281928122 1.203071208372362603 0.658047292653547382
6: -34.87065786149660974 1.2 0.666666666666666666666666666666667
7: 2.5 1 0.6
"""


def dense_tsit5():
    """The quartics of the seven stages as lists of the coefficients of theta to theta^4."""
    found = {}
    for line in DENSE_TSIT5.strip().splitlines():
        stage, numbers = line.split(":")
        stage, numbers = int(stage), [mpf(x) for x in numbers.split()]
        if stage == 1:
            k, root, p, q = numbers  # k θ (θ − root)(θ² − p θ + q)
            found[stage] = [-k * root * q, k * (q + root * p), -k * (p + root), k]
        elif stage <= 3:
            k, p, q = numbers  # k θ² (θ² − p θ + q)
            found[stage] = [mpf(0), k * q, -k * p, k]
        else:
            k, a, b = numbers  # k θ² (θ − a)(θ − b)
            found[stage] = [mpf(0), k * a * b, -k * (a + b), k]
    return found


def trees(order):
    """Rooted trees by their number of nodes, each the sorted tuple of its branches."""
    found = {1: [()]}
    for n in range(2, order + 1):
        def branches(left, most):
            if left == 0:
                yield ()
                return
            for size in range(min(left, most[0]), 0, -1):
                for index, tree in enumerate(found[size]):
                    if (size, index) <= most:
                        for rest in branches(left - size, (size, index)):
                            yield (tree, *rest)
        found[n] = list(branches(n - 1, (n - 1, 10**9)))
    return found


def size(tree):
    return 1 + sum(size(branch) for branch in tree)


def density(tree):
    product = mpf(size(tree))
    for branch in tree:
        product *= density(branch)
    return product


def weights(tree, stages, a):
    """The product over the branches at each stage."""
    product = {i: mpf(1) for i in stages}
    for branch in tree:
        inner = weights(branch, stages, a)
        for i in stages:
            product[i] *= sum((x * inner[j] for j, x in a.get(str(i), [])), mpf(0))
    return product


def defect(b, theta, a, stages, order):
    """The largest miss of the conditions of all trees of that many nodes."""
    worst = mpf(0)
    for tree in trees(order)[order]:
        inner = weights(tree, stages, a)
        total = sum((x * inner[j] for j, x in b), mpf(0))
        worst = max(worst, abs(total - mpf(theta) ** order / density(tree)))
    return worst


def nested(theta, table, b, end):
    """The weights of the dense output of DOP853 at theta, of the stages 1 to 16."""
    one = 1 - mpf(theta)
    total = {j: mpf(0) for j in range(1, 17)}

    def add(factor, entries):
        for j, x in entries:
            total[j] += factor * x

    difference = b
    spline = [(1, mpf(1))] + [(j, -x) for j, x in b]
    last = [(j, 2 * x) for j, x in b] + [(13, mpf(-1)), (1, mpf(-1))]
    s = mpf(theta)
    add(s, difference)
    add(s * one, spline)
    add(s * one * s, last)
    add(s * one * s * one, table["dense 4"])
    add(s * one * s * one * s, table["dense 5"])
    add(s * one * s * one * s * one, table["dense 6"])
    add(s * one * s * one * s * one * s, table["dense 7"])
    return list(total.items())


def dd(x):
    high = float(x)
    return f"Dd::sum({high!r}, {float(x - mpf(high))!r})"


def single(x):
    return f"Dd::sum({float(x)!r}, 0.0)"


def show(table, as_dd):
    for name, entries in table.items():
        node = sum(x for _, x in entries)
        number = dd if as_dd else single
        shown = ", ".join(f"({j - 1}, {number(x)})" for j, x in entries)
        print(f"// {name}\n({number(node)}, &[{shown}]),")


def report(name, value):
    print(f"// {name}: {nstr(value, 2)}")


if __name__ == "__main__":
    a = dict(DOP853)
    a["13"] = DOP853["b"]
    stages = range(1, 17)
    for order in range(1, 10):
        report(f"dop853, order {order}", defect(DOP853["b"], 1, a, stages, order))
    lower = [(j, x) for j, x in DOP853["error 5"]]
    fifth = {j: x for j, x in DOP853["b"]}
    for j, x in lower:
        fifth[j] = fifth.get(j, mpf(0)) - x
    for order in range(1, 7):
        report(f"dop853, lower order {order}", defect(list(fifth.items()), 1, a, stages, order))
    for order in range(1, 5):
        report(f"dop853, of order 3, {order}", defect(DOP853["of order 3"], 1, a, stages, order))
    for order in range(1, 9):
        weights_at = nested("0.3", DOP853, DOP853["b"], 13)
        report(f"dop853, dense {order}", defect(weights_at, "0.3", a, stages, order))
    a = dict(TSIT5)
    a["7"] = TSIT5["b"]
    stages = range(1, 8)
    for order in range(1, 7):
        report(f"tsit5, order {order}", defect(TSIT5["b"], 1, a, stages, order))
    lower = {j: x for j, x in TSIT5["b"]}
    for j, x in TSIT5["error 4"]:
        lower[j] = lower.get(j, mpf(0)) - x
    for order in range(1, 6):
        report(f"tsit5, lower order {order}", defect(list(lower.items()), 1, a, stages, order))
    dense = dense_tsit5()
    for order in range(1, 6):
        at = [(j, sum(x * mpf("0.3") ** (k + 1) for k, x in enumerate(row))) for j, row in dense.items()]
        report(f"tsit5, dense {order}", defect(at, "0.3", a, stages, order))
    for j, row in dense.items():
        print("//", j, [nstr(x, 20) for x in row], nstr(sum(row), 20))
    show(DOP853, True)
    show(TSIT5, False)
    show({f"dense {k + 1}": [(j, row[k]) for j, row in dense.items() if row[k] != 0] for k in range(4)}, False)
