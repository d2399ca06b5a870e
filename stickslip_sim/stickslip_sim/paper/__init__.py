"""The paper figure by figure: its pictures, its cycle figures and its statements, from any run."""
