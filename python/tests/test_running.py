"""Long work: Ctrl-C ends it, other threads run meanwhile, progress is told."""

import signal
import subprocess
import sys
import textwrap
import threading

import pytest

import pulloff

MANY = "{'preset': 'fig-9', 'axis': [{'key': 'gap.amplitude', 'linear': {'from': 1e-4, 'to': 4e-3, 'count': 1000000}}]}"
WORK = {
    "trace": "while True: problem.trace(progress=told)",
    "unload": "while True: problem.unload(progress=told)",
    "cycle": "while True: loop.cycle(progress=told)",
    "map": "while True: problem.map(('gap.amplitude', 1e-3, 4e-3), ('material.work_of_adhesion', 1e-3, 1e-2), progress=told)",
    "stability": "while True: problem.stability(progress=told)",
    "fit": "fit()",
    "sweep": f"pulloff.sweep({MANY}, progress=told)",
    # A contact so large that its table takes long.
    "gap": "told(0.0), [problem.replace({'gap.amplitude': 1e-3 * (1 + 1e-6 * i)}).gap(2000.0, 2001.0) for i in range(10**6)]",
}


@pytest.mark.parametrize("name", WORK)
def test_ctrl_c_ends_it(name):
    code = f"""
        import pulloff, sys
        problem, loop = pulloff.Problem("fig-9"), pulloff.Problem("fig-9-cycle")
        begun = False
        def fit():
            curve = pulloff.Problem("fig-9").trace()
            points = {{"approach": curve.approach, "force": curve.force}}
            free = ["material.work_of_adhesion", "gap.amplitude", "gap.wavelength"]
            while True:
                problem.replace({{"gap.amplitude": 3e-3}}).fit(points, free, bootstrap=10000, progress=told)
        def told(share):
            global begun
            assert 0.0 <= share <= 1.0
            if not begun:
                begun = True
                print("begun", flush=True)
        try:
            {WORK[name]}
        except KeyboardInterrupt:
            print("interrupted", flush=True)
    """
    with subprocess.Popen([sys.executable, "-c", textwrap.dedent(code)], stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout.readline() == "begun\n"
            process.send_signal(signal.SIGINT)
            out, _ = process.communicate(timeout=60)
        finally:
            process.kill()
    assert out == "interrupted\n" and process.returncode == 0


@pytest.mark.parametrize("out", ["", "rows.csv"])
def test_ctrl_c_leaves_the_rows_that_are_done(out, tmp_path):
    code = f"""
        import numpy, pickle, pulloff, sys
        done = []
        def told(share):
            done.append(share)
            if share > 20 / 1000000:
                print("begun", flush=True) if len(done) < 10**6 else None
                done.extend([0.0] * 10**6)
        try:
            pulloff.sweep({MANY}, progress=told{", out='rows.csv'" if out else ""})
        except KeyboardInterrupt as stopped:
            assert type(stopped) is pulloff.Interrupted and not isinstance(stopped, Exception)
            rows = stopped.result
            assert rows.row.tolist() == list(range(rows.row_count)) and rows.row_count > 10
            assert set(rows.error) == {{None}} and not numpy.isnan(rows["gap.amplitude"]).any()
            again = pickle.loads(pickle.dumps(stopped))
            assert again.result == rows and str(again) == str(stopped)
            few = [{{"key": "gap.amplitude", "values": rows["gap.amplitude"][:10].tolist()}}]
            assert pulloff.sweep({{"preset": "fig-9", "axis": few}}).last_contact_force.tolist() == rows.last_contact_force[:10].tolist()
            print(rows.row_count, stopped, flush=True)
    """
    call = [sys.executable, "-c", textwrap.dedent(code)]
    with subprocess.Popen(call, stdout=subprocess.PIPE, text=True, cwd=tmp_path) as process:
        try:
            assert process.stdout.readline() == "begun\n"
            process.send_signal(signal.SIGINT)
            said, _ = process.communicate(timeout=60)
        finally:
            process.kill()
    count, words = said.strip().split(" ", 1)
    assert words.startswith(f"stopped with {count} rows") and process.returncode == 0
    if out:
        assert (tmp_path / out).read_text().count("\n") == int(count) + 1
        assert "the same call continues from there" in words


def test_an_exception_of_progress_ends_it(fig_9):
    class Enough(Exception):
        pass

    def told(share):
        raise Enough(share)

    for work in (fig_9.trace, fig_9.unload, pulloff.Problem("fig-9-cycle").cycle):
        with pytest.raises(Enough):
            work(progress=told)
    with pytest.raises(Enough):
        pulloff.sweep(eval(MANY), progress=told)


def test_other_threads_run_meanwhile():
    """A thread of Python finishes while another computes: it could not, if the lock were held."""
    done = threading.Event()
    ran = []

    def told(share):
        if not ran:
            thread = threading.Thread(target=done.set)
            thread.start()
            ran.append(thread)

    loop = pulloff.Problem("fig-9-cycle")
    while not done.is_set():
        loop.cycle(progress=told)
    ran[0].join()


def test_many_threads_have_the_same_numbers(fig_9):
    wanted = fig_9.unload(areas=False, admissibility=False).before_force.tolist()
    found = []

    def work():
        found.append(fig_9.unload(areas=False, admissibility=False, progress=False).before_force.tolist())

    threads = [threading.Thread(target=work) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == [wanted] * 8


def test_a_bar_is_shown_where_it_is_wanted(fig_9, capsys):
    pytest.importorskip("tqdm")
    fig_9.unload(progress=True)
    assert "unload" in capsys.readouterr().err
    fig_9.unload(progress=False)
    fig_9.unload()
    assert capsys.readouterr().err == ""
