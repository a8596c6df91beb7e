#!/usr/bin/env python3
"""Do the marks tell surgeons apart? Scripted surgeons of several levels do a case; their scores become a table and two figures.

    score_study.py [OUT] [CASE] [LEARNERS] [SESSIONS] [SECONDS]        learners of each level, sessions of each

A session that has no mark (docs/teach/scoring.md#whether-there-is-a-mark-at-all) counts as 0 points.
AUC: the share of pairs of an expert and a careless surgeon in which the expert has more points (0.5: the marks say nothing).
G: the reliability of the mean mark of a surgeon (Brennan 2001), as `burr study reliability` computes it from the same table.
The surgeons are scripts (docs/understand/surgeon.md): a mark that tells them apart may still fail on people.
"""
import csv
import pathlib
import sys

import numpy as np

import burr
import burr.program

LEVELS = ("expert", "average", "careless")


def auc(high, low):
    """The share of pairs in which `high` is above; equal marks count half (Mann and Whitney)."""
    high, low = np.asarray(high, float)[:, None], np.asarray(low, float)[None, :]
    return float(np.mean((high > low) + 0.5 * (high == low)))


def reliability(marks):
    """G of the mean of n marks; marks: (learners, occasions). Components below 0 count as 0."""
    marks = np.asarray(marks, float)
    people, occasions = marks.shape
    rows, columns, mean = marks.mean(axis=1), marks.mean(axis=0), marks.mean()
    rest = marks - rows[:, None] - columns[None, :] + mean
    of_rest = (rest ** 2).sum() / ((people - 1) * (occasions - 1))
    of_people = occasions * ((rows - mean) ** 2).sum() / (people - 1)
    person = max(0.0, (of_people - of_rest) / occasions)
    return person / (person + of_rest / occasions) if person > 0 else 0.0


def main(out="study", case="tooth", learners=2, sessions=2, seconds=300):
    folder = pathlib.Path(out)
    folder.mkdir(parents=True, exist_ok=True)
    learners, sessions, table = int(learners), int(sessions), []
    for level in LEVELS:
        for learner in range(learners):
            for occasion in range(sessions):
                seed = 1000 + 100 * learner + occasion
                file = folder / f"{level}-{seed}.mcap"
                burr.program.run("surgeon", case, "--level", level, "--seed", seed, "--seconds", seconds, "--record", file, "--json")
                score = burr.Recording(str(file)).score()
                file.unlink()  # 250 kB a second; the seed makes it again
                table.append({"learner": f"{level}-{learner + 1}", "level": level, "seed": seed, "mark": score["product"]["points"] or 0.0,
                              **{item["id"]: item["verdict"] for item in score["items"]}})
    with open(folder / "marks.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, table[0].keys())
        writer.writeheader()
        writer.writerows({name: burr.table_text(cell) if isinstance(cell, str) else cell for name, cell in row.items()} for row in table)
    marks = {level: np.array([row["mark"] for row in table if row["level"] == level]).reshape(learners, sessions) for level in LEVELS}
    found = {"auc": auc(marks["expert"].ravel(), marks["careless"].ravel()), "g": reliability(np.concatenate(list(marks.values())))}
    for level in LEVELS:
        print(f"{level:>9}: {marks[level].mean():.1f} points")
    print(f"AUC of expert and careless {found['auc']:.2f}; G of the mean of {sessions} marks {found['g']:.2f}")
    return table, found


if __name__ == "__main__":
    main(*sys.argv[1:])
