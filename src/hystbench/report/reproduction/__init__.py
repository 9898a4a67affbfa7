"""The front page of the results: verdict, ours beside the paper's, tables, figures."""
