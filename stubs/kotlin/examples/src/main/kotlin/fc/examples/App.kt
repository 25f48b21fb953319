/**
 * An app that tests a robot. It calls every command with the example in the spec, receives the reports and the picture
 * of a map, and prints the outcome of each.
 */
@file:JvmName("App")

package fc.examples

import fc.Client
import fc.Fc
import fc.Operations
import fc.runtime.CallError
import fc.runtime.Command
import fc.runtime.DataConnection
import fc.runtime.Message
import fc.runtime.Reports
import java.util.Locale
import kotlin.system.exitProcess
import kotlinx.coroutines.runBlocking
import kotlinx.coroutines.withTimeout

private const val USAGE = """Calls every command of a robot and prints what came of it.

Usage: run app [--host 127.0.0.1] [--command-port PORT] [--data-port PORT] [--gzip-from BYTES]
           [--lang zh|en]

Without ports, those of the spec. With --gzip-from, whatever has so many bytes is compressed.
Without --lang, the language of the environment."""

internal fun main(arguments: Array<String>) {
    val told = Arguments(arguments, USAGE)
    val tour = Tour(told.isChinese)
    val fault = runBlocking {
        try {
            Client.connect(told.client()).use { client -> tour.take(client) }
            null
        } catch (failure: Exception) {
            failure.message ?: failure.toString()
        }
    }
    tour.print()
    if (fault != null) System.err.println(fault)
    exitProcess(if (fault == null && tour.failed == 0) 0 else 1)
}

/** The outcome of each operation so far. */
private class Tour(private val isChinese: Boolean) {
    private val rows =
        arrayListOf(pick(listOf("功能码", "类型", "名称", "说明", "结果"), listOf("Code", "Kind", "Name", "Title", "Outcome")))
    var failed = 0
        private set

    suspend fun take(client: Client) {
        val reports = client.reports()
        val data = client.data()
        data.connected()
        for (command in Fc.commands) call(client, command)
        receiveAll(reports)
        receivePicture(data)
    }

    /** Returns the value in the language of the user. */
    private fun <T> pick(zh: T, en: T): T = if (isChinese) zh else en

    private fun add(code: Int, kind: String, name: String, title: String, outcome: String) {
        rows.add(listOf(String.format(Locale.ROOT, "0x%04X", code), kind, name, title, outcome))
    }

    private suspend fun <Q : Message, A : Message> call(client: Client, command: Command<Q, A>) {
        val outcome = try {
            client.connection.call(command, command.request.example())
            pick("成功", "answered")
        } catch (error: CallError) {
            failed++
            error.message
        }
        add(command.code, pick("指令", "command"), command.name, pick(command.titleZh, command.titleEn), outcome)
    }

    /** Waits until every report has arrived once. */
    private suspend fun receiveAll(reports: Reports) {
        val missing = Fc.reports.associateBy { it.code }.toMutableMap()
        while (missing.isNotEmpty()) {
            val report = withTimeout(Arguments.PATIENCE_MILLIS) { reports.receive() } ?: error("the robot has left")
            val known = missing.remove(report.code) ?: continue
            val title = pick(known.titleZh, known.titleEn)
            add(known.code, pick("主动上报", "report"), known.name, title, pick("收到", "received"))
        }
    }

    /** Waits for the picture that the call for a map image requested. The runtime has verified its digest. */
    private suspend fun receivePicture(data: DataConnection) {
        val frame = withTimeout(Arguments.PATIENCE_MILLIS) { data.receive() }
        check(frame.code == Operations.getMapImage.code) { "unexpected picture of ${frame.code}" }
        val ordered = Operations.getMapImage
        val (size, id) = frame.data.size to frame.id
        val outcome = pick("收到 $size 字节，msgId $id，MD5 一致", "received $size bytes, msgId $id, MD5 verified")
        add(frame.code, pick("数据流", "stream"), ordered.name, pick(ordered.titleZh, ordered.titleEn), outcome)
    }

    fun print() {
        val widths = rows[0].indices.map { column -> rows.maxOf { columns(it[column]) } }
        for (row in rows) {
            println(row.mapIndexed { column, text -> text + " ".repeat(widths[column] - columns(text)) }.joinToString("  ").trimEnd())
        }
    }

    /** Columns of a text on a terminal. A Chinese character takes two. */
    private fun columns(text: String): Int = text.sumOf { if (it.code >= 0x2E80) 2.toInt() else 1 }
}
