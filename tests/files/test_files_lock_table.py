from stages.files import lock_table


def test_the_table_to_copy_locks_the_shapes_and_keeps_the_actors_bans(tmp_path):
    path = tmp_path / "key_shapes.tsv"
    header = "actor\tregion\tshot\tframe\tstate\n"
    rows = "eve\tmouth\ta\t7\tbanned\neve\tmouth\ta\t9\tlocked\nbob\tmouth\tb\t3\tbanned\n"
    path.write_text(header + rows)
    text = lock_table.locking(path, "eve", [("mouth", "a", 12)])
    assert text == header + "eve\tmouth\ta\t12\tlocked\neve\tmouth\ta\t7\tbanned\n"
    path.write_text(text)
    place = {("a", frame): frame for frame in range(20)}
    assert lock_table.read(path, "eve", place) == {"mouth": {"locked": [12], "banned": [7]}}
