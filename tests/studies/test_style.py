"""The style of pictures."""

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from hybrid_rl.studies.style import legend_below


def test_a_long_label_of_a_legend_is_wrapped_and_stays_in_the_picture():
    figure = Figure(figsize=(4.4, 3.2), layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.subplots()
    axes.plot([0, 1], label="no gradient through the models, and a critic that learns from one")
    axes.plot([1, 0], label="short")
    legend_below(axes)
    figure.canvas.draw()
    long, short = axes.get_legend().get_texts()
    assert long.get_text().count("\n") == 1
    assert short.get_text() == "short"
    assert axes.get_legend().get_window_extent().x1 <= figure.bbox.x1
