#pragma once
// How the report looks.

namespace meniscus::measure {

inline constexpr const char* kReportStyle = R"(
:root{--ink:#1c2530;--soft:#5d6b7a;--line:#dfe5eb;--paper:#fff;--ground:#f5f7f9;--link:#245a9c}
*{box-sizing:border-box}html{scroll-behavior:smooth;scroll-padding-top:52px}
body{margin:0;font:15px/1.5 system-ui,"Segoe UI",Roboto,"DejaVu Sans",sans-serif;color:var(--ink);background:var(--ground)}
a{color:var(--link);text-decoration:none}a:hover{text-decoration:underline}
header{background:linear-gradient(120deg,#17344f,#2c6073);color:#fff;padding:30px 0 26px}
header h1{margin:0 0 6px;font-size:27px;font-weight:650;letter-spacing:-.01em}header p{margin:0;color:#cfe0ea}
main,header>div,nav>div{max-width:1200px;margin:0 auto;padding:0 24px}
nav{position:sticky;top:0;background:var(--paper);border-bottom:1px solid var(--line);z-index:2}
nav a{display:inline-block;padding:10px 18px 10px 0;color:var(--ink)}
section{margin:34px 0}h2{font-size:20px;margin:0 0 4px}h3{font-size:15.5px;margin:22px 0 8px}
section>p{margin:0 0 14px;color:var(--soft);max-width:78ch}
.pair{display:flex;flex-wrap:wrap;gap:16px}
.plot{background:var(--paper);border:1px solid var(--line);border-radius:8px;padding:8px}
svg{display:block;max-width:100%;height:auto}svg text{font-size:11px;fill:var(--soft)}
svg .title{font-size:13px;font-weight:600;fill:var(--ink)}svg .label{font-size:12px;fill:var(--ink)}
svg .note{font-style:italic}svg .major{stroke:#d5dce3}svg .minor{stroke:#eef1f4}
svg .frame{fill:none;stroke:#9aa7b3}svg .floor{stroke:#9aa7b3;stroke-dasharray:5 4}
svg .front{fill:none;stroke:#1c2530;stroke-width:1.1;stroke-dasharray:2 3;opacity:.65}
svg a:hover>*{stroke-width:4}
.legend{display:flex;flex-wrap:wrap;gap:4px 18px;margin:0 0 12px;font-size:13.5px}
.legend i,.scale i{display:inline-block;width:12px;height:12px;border-radius:3px;margin-right:6px;vertical-align:-1px}
.finding{background:#e9f2ec;border-left:4px solid #59a14f;padding:8px 14px;margin:12px 0;border-radius:0 6px 6px 0}
.finding.none{background:#f6efe2;border-color:#f28e2b}
.scroll{overflow-x:auto;background:var(--paper);border:1px solid var(--line);border-radius:8px}
table{border-collapse:collapse;width:100%;font-size:13px;font-variant-numeric:tabular-nums}
th,td{padding:5px 9px;text-align:right;white-space:nowrap;border-bottom:1px solid #eef1f4}
th{font-weight:600;color:var(--soft);background:#fafbfc;position:sticky;top:0}
td.t,th.t{text-align:left}tr:last-child td{border-bottom:0}tr:target td{background:#fff6d6}
td.wrap{white-space:normal;min-width:17em;text-align:left}
.cards{display:grid;grid-template-columns:repeat(auto-fill,minmax(350px,1fr));gap:14px}
.card{background:var(--paper);border:1px solid var(--line);border-radius:8px;overflow:hidden;font-size:13px}
.card:target{outline:3px solid #f2c14e}.card img{display:block;width:100%;background:#101418}
.card div{padding:8px 11px}.card b{font-weight:600}.card small{color:var(--soft)}
.bar{display:flex;height:9px;border-radius:3px;overflow:hidden;margin-top:6px;padding:0!important}
.bar span{display:block;height:100%}
.scale{display:flex;flex-wrap:wrap;gap:3px 14px;font-size:12.5px;color:var(--soft);margin:0 0 12px}
.matrix th{text-align:center}.matrix th.t{text-align:left}.pair+.scroll{margin-top:14px}.matrix td{text-align:center;font-size:12px;min-width:92px}.matrix td.t{text-align:left}
.matrix td.t small{display:block;color:var(--soft);white-space:normal;min-width:26em}
.matrix a{color:inherit;display:block}
.exact{background:#cfe9d4}.slight{background:#eef0bf}.degraded{background:#fbd9a5}.bad{background:#f6b48f}
.refused{background:#d8e2f0}.failed{background:#e8696b;color:#fff;font-weight:600}
.ratio{font-weight:600}footer{color:var(--soft);font-size:13px;padding:10px 0 50px}
@media print{nav{display:none}}
)";

}  // namespace meniscus::measure
